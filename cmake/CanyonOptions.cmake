# Language level, warning and floating-point flags, build options.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

option(CANYON_TESTS "Build the tests" ON)
option(CANYON_BENCH "Build the benchmarks" OFF)
option(CANYON_WERROR "Treat warnings as errors" ON)
option(CANYON_WITH_PCL "Registration methods that need PCL (pcl_...)" ON)
option(CANYON_WITH_ASSIMP "Scenes in glTF and what else assimp reads" ON)
option(CANYON_WITH_PROJ "Scenes in the coordinates of a map (PROJ)" ON)
option(CANYON_WITH_CERES "Fit of noise processes to inertial logs, smoothing by factor graphs (Ceres)" ON)
set(CANYON_SANITIZE "" CACHE STRING "Sanitizers, for example address,undefined")
# The address sanitizer takes what is both in the program and in a part that it opens for a violation of one definition.
if(CANYON_SANITIZE)
  set(open_late OFF)
else()
  set(open_late ON)
endif()
option(CANYON_OPEN_LATE "The program opens PCL, assimp, PROJ and Ceres at their first use" ${open_late})
if(CANYON_OPEN_LATE AND CANYON_SANITIZE MATCHES "address")
  message(FATAL_ERROR "CANYON_SANITIZE=${CANYON_SANITIZE} needs -DCANYON_OPEN_LATE=OFF: the address sanitizer takes what is both in "
                      "the program and in a part that it opens for a violation of one definition")
endif()

# Headers are included as "canyon/core/time.h", in this tree as where they are installed.
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/include/canyon)
foreach(folder IN ITEMS core scene gnss inertial lidar fusion mission study report apps tests bench)
  file(CREATE_LINK ${CMAKE_SOURCE_DIR}/${folder} ${CMAKE_BINARY_DIR}/include/canyon/${folder} SYMBOLIC)
endforeach()
add_library(canyon_flags INTERFACE)
target_include_directories(canyon_flags INTERFACE $<BUILD_INTERFACE:${CMAKE_BINARY_DIR}/include> $<BUILD_INTERFACE:${CMAKE_BINARY_DIR}/generated>
                                                  $<INSTALL_INTERFACE:include>)
target_compile_features(canyon_flags INTERFACE cxx_std_20)
# -ffp-contract=off: a result must not depend on whether the compiler found a fused multiply-add.
# -fno-tree-*-vectorize: where two numbers side by side are converted to single precision and back, g++ 12 drops both conversions
# (tests/core/math/compiler_test.cpp). Statements are never made vectors of, loops where a file is made for it: CANYON_VECTOR_LOOPS.
target_compile_options(canyon_flags INTERFACE -ffp-contract=off $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:-fno-tree-slp-vectorize>>
                                              $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:-fno-tree-loop-vectorize>>
                                              $<BUILD_INTERFACE:-Wall> $<BUILD_INTERFACE:-Wextra> $<BUILD_INTERFACE:-Wpedantic>
                                              $<BUILD_INTERFACE:-Wshadow> $<BUILD_INTERFACE:-Wnon-virtual-dtor>)
# oneTBB's target says so to whoever links it in a debug build; what shares a precompiled header with them must be told the same.
target_compile_definitions(canyon_flags INTERFACE $<BUILD_INTERFACE:$<$<CONFIG:Debug>:TBB_USE_DEBUG>>)
if(CANYON_WERROR)
  target_compile_options(canyon_flags INTERFACE $<BUILD_INTERFACE:-Werror>)
endif()
if(CANYON_SANITIZE)
  # Three checks of the undefined-behaviour sanitizer are given up, since they double the time of compilation.
  # What they find ends the program: otherwise undefined behaviour would be printed, and the test would pass.
  target_compile_options(canyon_flags INTERFACE -fsanitize=${CANYON_SANITIZE} -fno-sanitize=null,alignment,vptr
                                                -fno-sanitize-recover=all -fno-omit-frame-pointer)
  # With them g++ takes parts of std::regex for uninitialised.
  target_compile_options(canyon_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_link_options(canyon_flags INTERFACE -fsanitize=${CANYON_SANITIZE})
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")
# g++ looks for garbage of its own from 128 MB on, which takes a tenth of its time and frees little.
target_compile_options(canyon_flags INTERFACE $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=1048576>>)
# The largest joined files take 2.4 GB: Ninja runs no more compilers than memory holds.
cmake_host_system_information(RESULT memory_mb QUERY TOTAL_PHYSICAL_MEMORY)
math(EXPR compilers "${memory_mb} / 2500 + 1")
set_property(GLOBAL PROPERTY JOB_POOLS compilers=${compilers})
set(CMAKE_JOB_POOL_COMPILE compilers)
# Of a file with loops over plain arrays.
set(CANYON_VECTOR_LOOPS "-O3;$<$<CXX_COMPILER_ID:GNU>:-ftree-loop-vectorize>")

# Parsing the standard library and Eigen is half of the time of most files, and joined files share it too. ccache knows no files
# with precompiled headers; whoever builds the same tree again and again chooses it with -DCANYON_PRECOMPILED_HEADERS=OFF, which
# takes about four times as long until the cache is full.
option(CANYON_PRECOMPILED_HEADERS "Precompile the headers that nearly all files include" ON)
find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CANYON_PRECOMPILED_HEADERS)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()
