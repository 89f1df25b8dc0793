#pragma once

namespace canyon::apps {

/// The whole program. Exit status: 0 done (a failed mission is a result), 1 the computation could not finish, 2 bad
/// input, 130 after Ctrl-C. Errors are one line on stderr. `commit`: of the source, for the record; may be empty.
int run_command_line(int argc, char** argv, const char* commit);

}  // namespace canyon::apps
