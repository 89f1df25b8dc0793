# cmake -DSOURCE=DIR -DOUT=FILE -P commit.cmake: a source file that holds the commit of the tree in DIR, "-modified" behind
# it if files that git knows differ from it. Of a tree that is no checkout: what `git archive` wrote into commit.txt, or nothing.
set(commit "")
find_program(GIT git)
if(GIT AND EXISTS ${SOURCE}/.git)
  # The tree may belong to somebody else than the one who builds.
  set(git ${GIT} -c safe.directory=${SOURCE} --no-optional-locks -C ${SOURCE})
  execute_process(COMMAND ${git} rev-parse --verify HEAD OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  execute_process(COMMAND ${git} status --porcelain --untracked-files=no OUTPUT_VARIABLE changes ERROR_QUIET)
  if(commit AND changes)
    string(APPEND commit "-modified")
  endif()
elseif(EXISTS ${SOURCE}/cmake/commit.txt)
  file(STRINGS ${SOURCE}/cmake/commit.txt archived REGEX "^[0-9a-f]+$")
  set(commit "${archived}")
endif()
file(CONFIGURE OUTPUT ${OUT} CONTENT "extern const char* const canyon_commit;\nconst char* const canyon_commit = \"${commit}\";\n" @ONLY)
