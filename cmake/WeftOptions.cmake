# What can be switched, and the compiler flags that every Weft target shares.

set(WEFT_COMPONENTS all CACHE STRING
    "What to build, with all that it needs: scheduler (the standard library alone), runtime, simulation, all")
set_property(CACHE WEFT_COMPONENTS PROPERTY STRINGS scheduler runtime simulation all)
if(NOT WEFT_COMPONENTS MATCHES "^(scheduler|runtime|simulation|all)$")
  message(FATAL_ERROR "WEFT_COMPONENTS: '${WEFT_COMPONENTS}' is none of scheduler, runtime, simulation, all")
endif()
set(own_build OFF)
if(PROJECT_IS_TOP_LEVEL AND WEFT_COMPONENTS STREQUAL "all")
  set(own_build ON)
endif()

option(WEFT_BUILD_TESTS "Build the tests" ${own_build})
option(WEFT_BUILD_BENCHMARKS "Build the benchmarks" ${own_build})
option(WEFT_WARNINGS_AS_ERRORS "Treat warnings as errors" OFF)
option(WEFT_VALIDATE "Check Weft's own invariants (scheduler/assert.h)" OFF)
option(WEFT_OCLGRIND "Add a ctest entry under oclgrind for each test of kernels" OFF)
set(WEFT_SANITIZE "" CACHE STRING "Sanitizers, as in -fsanitize=<value>: address,undefined or thread")
set(WEFT_PYTHON "" CACHE FILEPATH "Python with cmake/packages/python.txt; empty: leave those tests out")

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES AND PROJECT_IS_TOP_LEVEL)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

find_program(WEFT_CCACHE ccache)
mark_as_advanced(WEFT_CCACHE)
if(WEFT_CCACHE AND PROJECT_IS_TOP_LEVEL AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${WEFT_CCACHE})
endif()

if(PROJECT_IS_TOP_LEVEL)
  set(CMAKE_EXPORT_COMPILE_COMMANDS ON)                       # for clang-tidy and editors
  set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
endif()

configure_file(${PROJECT_SOURCE_DIR}/weft/version.h.in ${PROJECT_BINARY_DIR}/include/weft/version.h @ONLY)

# Flags that users of the installed libraries need as well: they compile our inline functions.
add_library(weft_options INTERFACE)
add_library(weft::options ALIAS weft_options)
target_compile_features(weft_options INTERFACE cxx_std_20)

# Strict arithmetic: the same bits on every device. A contracted a * b + c rounds once instead of
# twice, and would differ from a device without fused multiply-add. No fast-math, ever, in C++.
target_compile_options(weft_options INTERFACE -ffp-contract=off)

if(WEFT_VALIDATE)
  target_compile_definitions(weft_options INTERFACE $<BUILD_INTERFACE:WEFT_VALIDATE>)
endif()

if(WEFT_SANITIZE)
  target_compile_options(weft_options INTERFACE -fsanitize=${WEFT_SANITIZE}
                         -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(weft_options INTERFACE -fsanitize=${WEFT_SANITIZE})
endif()

# What only our own sources need; users of the installed libraries do not inherit it.
add_library(weft_warnings INTERFACE)
add_library(weft::warnings ALIAS weft_warnings)
set(warnings -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion -Wfloat-conversion
    -Wdouble-promotion
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)   # g++ 12 sees overlaps in std::string (GCC 105651)
if(WEFT_WARNINGS_AS_ERRORS)
  list(APPEND warnings -Werror)
endif()
target_compile_options(weft_warnings INTERFACE "$<BUILD_INTERFACE:${warnings}>")
