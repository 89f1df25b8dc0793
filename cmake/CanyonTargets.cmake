# canyon_precompile(TARGET ROOT): what nearly all files include is precompiled once, for ROOT (further arguments: headers of
# ROOT's own), and used by every TARGET. Short on purpose: <nlohmann/json.hpp> in it would cost each file 0.4 s.
# Behind them g++ 12 gives false alarms of strings inside the standard library, so those warnings are off; builds with ccache do
# without precompiled headers and keep them.
function(canyon_precompile target root)
  if(NOT CANYON_PRECOMPILED_HEADERS)
    return()
  endif()
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds> $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
                                           $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow> $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overread>
                                           $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  if(target STREQUAL root)
    target_precompile_headers(${target} PRIVATE <algorithm> <array> <cmath> <cstdint> <functional> <map> <memory> <optional>
                              <span> <string> <string_view> <vector> <Eigen/Core> <Eigen/Geometry>
                              <canyon/core/config/config.h> <canyon/core/earth/local_frame.h> <canyon/core/messages.h>
                              <canyon/core/result.h> ${ARGN})
  else()
    target_precompile_headers(${target} REUSE_FROM ${root})
  endif()
endfunction()

# canyon_join(TARGET): where headers are precompiled, files that follow one another are compiled as one, which more than halves the
# work: most of it is Eigen's templates, which they share. So names in the unnamed namespaces of a folder differ. Rooms whose files
# are alike by design (verbs) stay apart, and files with definitions of their own. Eight at a time: more save nothing.
set(CANYON_APART verbs verbs/lidar verbs/study tables contributing)
function(canyon_join target)
  if(NOT CANYON_PRECOMPILED_HEADERS)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  set(joined 0)
  foreach(source IN LISTS sources)
    cmake_path(GET source PARENT_PATH room)
    if(IS_ABSOLUTE ${source} OR room IN_LIST CANYON_APART)
      set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    else()
      math(EXPR part "${joined} / 8")
      math(EXPR joined "${joined} + 1")
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${target}_${part})
    endif()
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()

# canyon_library(NAME [NO_INSTALL] [LINK libs...] [PRIVATE libs...] [ONLY pattern] [EXCLUDE patterns...] [PRECOMPILE headers...]):
# every .cpp of the folder and its rooms but stress/ (whose path from the folder matches ONLY and none of EXCLUDE), one static library
# canyon_NAME; with NO_INSTALL it is the program's alone, no component of the package.
function(canyon_library name)
  cmake_parse_arguments(ARG "NO_INSTALL" "ONLY" "LINK;PRIVATE;EXCLUDE;PRECOMPILE" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  if(ARG_ONLY)
    list(FILTER sources INCLUDE REGEX ${ARG_ONLY})
  endif()
  foreach(pattern IN LISTS ARG_EXCLUDE)
    list(FILTER sources EXCLUDE REGEX ${pattern})
  endforeach()
  if(NOT ARG_ONLY)
    list(FILTER sources EXCLUDE REGEX "^stress/")
  endif()
  add_library(canyon_${name} STATIC ${sources})
  target_link_libraries(canyon_${name} PUBLIC canyon_flags ${ARG_LINK} PRIVATE ${ARG_PRIVATE})
  if(ARG_PRECOMPILE)
    canyon_precompile(canyon_${name} canyon_${name} ${ARG_PRECOMPILE})
  else()
    canyon_precompile(canyon_${name} canyon_core)
  endif()
  canyon_join(canyon_${name})
  set_property(GLOBAL APPEND PROPERTY canyon_libraries canyon_${name})
  if(NOT ARG_NO_INSTALL)
    canyon_install(${name})
  endif()
endfunction()

# The libraries of canyon_stress, for whoever runs their cases.
add_library(canyon_stress_cases INTERFACE)

# canyon_stress(FOLDER): the room stress/ of this folder, a library of its own: who wants the models need not link their extremes.
function(canyon_stress folder)
  canyon_library(${folder}_stress NO_INSTALL ONLY "^stress/" LINK ${ARGN})
  target_link_libraries(canyon_stress_cases INTERFACE canyon_${folder}_stress)
endfunction()

# canyon_install(NAME): the library canyon_NAME as canyon::NAME of the package that `cmake --install` makes.
function(canyon_install name)
  add_library(canyon::${name} ALIAS canyon_${name})
  set_target_properties(canyon_${name} PROPERTIES EXPORT_NAME ${name})
  install(TARGETS canyon_${name} EXPORT canyon ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
endfunction()

# The parts of canyon_part, for programs that are to have them all from the start.
add_library(canyon_parts INTERFACE)

# canyon_open_parts(TARGET): this program opens parts when it first uses them, or, where the build opens none late, is linked with them.
# A start with all of them costs 0.15 s.
function(canyon_open_parts target)
  if(CANYON_OPEN_LATE)
    # What a part shares with the program, such as the thread pool, is the program's.
    set_target_properties(${target} PROPERTIES ENABLE_EXPORTS ON)
    get_property(modules GLOBAL PROPERTY canyon_modules)
    if(modules)  # a build may leave all of them out
      add_dependencies(${target} ${modules})
    endif()
  else()
    target_link_libraries(${target} PRIVATE canyon_parts)
  endif()
endfunction()

# canyon_part(NAME OF folder SOURCES files... PRIVATE libs...): what of a folder stands on a large library, with its table of
# functions canyon_NAME_part (core/process/library_part.h). As a static library canyon_NAME for programs that want it linked; as
# a shared object in lib/canyon, which the program `canyon` opens when it is first used.
function(canyon_part name)
  cmake_parse_arguments(ARG "" "OF" "SOURCES;PRIVATE" ${ARGN})
  add_library(canyon_${name} STATIC ${ARG_SOURCES})
  target_link_libraries(canyon_${name} PUBLIC canyon_${ARG_OF} PRIVATE ${ARG_PRIVATE})
  target_link_options(canyon_${name} INTERFACE LINKER:--undefined=canyon_${name}_part)
  canyon_precompile(canyon_${name} canyon_core)
  set_property(GLOBAL APPEND PROPERTY canyon_libraries canyon_${name})
  canyon_install(${name})
  target_link_libraries(canyon_parts INTERFACE canyon_${name})
  if(CANYON_OPEN_LATE)
    # Written once: a file of the same text keeps its time, so that configuring again builds nothing.
    file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/part.cpp CONTENT "")
    add_library(canyon_${name}_module MODULE ${CMAKE_BINARY_DIR}/generated/part.cpp)
    target_link_libraries(canyon_${name}_module PRIVATE canyon_${name})
    set_target_properties(canyon_${name}_module PROPERTIES OUTPUT_NAME canyon_${name} LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib/canyon)
    install(TARGETS canyon_${name}_module LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/canyon)
    set_property(GLOBAL APPEND PROPERTY canyon_modules canyon_${name}_module)
  endif()
endfunction()

# canyon_embed(OUT_VARIABLE FILE...): sources that hold the files' bytes and the table that core/process/embedded.cpp reads.
function(canyon_embed out_variable)
  set(sources "")
  set(declarations "")
  set(rows "")
  foreach(file IN LISTS ARGN)
    file(RELATIVE_PATH key ${CMAKE_SOURCE_DIR} ${file})
    string(MAKE_C_IDENTIFIER "embedded_${key}" identifier)
    set(out ${CMAKE_BINARY_DIR}/generated/embedded/${identifier}.cpp)
    add_custom_command(
      OUTPUT ${out}
      COMMAND ${CMAKE_COMMAND} -DIN=${file} -DIDENTIFIER=${identifier} -DOUT=${out} -P ${CMAKE_SOURCE_DIR}/cmake/embed.cmake
      DEPENDS ${file} ${CMAKE_SOURCE_DIR}/cmake/embed.cmake
      VERBATIM)
    list(APPEND sources ${out})
    string(APPEND declarations "extern const unsigned char ${identifier}[];\nextern const unsigned long ${identifier}_size;\n")
    string(APPEND rows "    {\"${key}\", ${identifier}, ${identifier}_size},\n")
  endforeach()
  set(table ${CMAKE_BINARY_DIR}/generated/embedded/table.inc)
  file(CONFIGURE OUTPUT ${table} CONTENT "${declarations}const EmbeddedRow kEmbeddedRows[] = {\n${rows}    {\"\", nullptr, 0},\n};\n" @ONLY)
  set(${out_variable} ${sources} PARENT_SCOPE)
endfunction()

# canyon_test(FOLDER LINK libs... [EXCLUDE patterns...] [SHARED_OUT suites...] [TOGETHER suites...]): every .cpp of tests/FOLDER
# and its rooms in one executable, one ctest entry per test case; but the many small cases of a suite that is shared out are done
# by eight processes, and those of a suite that goes together, which share what takes long to make, by one.
# A name that contains "Nightly" gets the label nightly and is left out of ./test.sh.
function(canyon_test folder)
  cmake_parse_arguments(ARG "" "" "LINK;EXCLUDE;SHARED_OUT;TOGETHER" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.cpp)
  foreach(pattern IN LISTS ARG_EXCLUDE)
    list(FILTER sources EXCLUDE REGEX ${pattern})
  endforeach()
  if(NOT sources)
    return()
  endif()
  set(target canyon_${folder}_tests)
  add_executable(${target} ${sources})
  target_link_libraries(${target} PRIVATE canyon_test_support ${ARG_LINK} GTest::gmock GTest::gtest_main)
  canyon_precompile(${target} canyon_test_support)
  canyon_join(${target})
  set(alone "-*Nightly*")
  foreach(suite IN LISTS ARG_SHARED_OUT)
    string(APPEND alone ":*/${suite}.*")
    foreach(share RANGE 1 8)
      math(EXPR index "${share} - 1")
      add_test(NAME ${suite}.Share${share}Of8 COMMAND ${target} --gtest_filter=*/${suite}.*)
      set_tests_properties(${suite}.Share${share}Of8 PROPERTIES LABELS ${folder} TIMEOUT 900
                           ENVIRONMENT "GTEST_TOTAL_SHARDS=8;GTEST_SHARD_INDEX=${index}")
    endforeach()
  endforeach()
  foreach(suite IN LISTS ARG_TOGETHER)
    string(APPEND alone ":${suite}.*")
    add_test(NAME ${suite}.All COMMAND ${target} --gtest_filter=${suite}.*-*Nightly*)
    set_tests_properties(${suite}.All PROPERTIES LABELS ${folder} TIMEOUT 900)
  endforeach()
  gtest_discover_tests(${target} DISCOVERY_MODE PRE_TEST TEST_FILTER "${alone}" PROPERTIES LABELS ${folder} TIMEOUT 900)
  gtest_discover_tests(${target} DISCOVERY_MODE PRE_TEST TEST_FILTER "*Nightly*" TEST_LIST ${target}_nightly
                       PROPERTIES LABELS "nightly" TIMEOUT 3600)
endfunction()
