# Tests. Labels: unit kernels scheduler determinism threads cli cluster contact analysis stability
# fuzz install bench-smoke oclgrind.
# No test asserts a time: how long things take tell the benchmarks.
#
#   weft_test(NAME strips LABELS unit SOURCES strips_test.cpp LIBS weft::simulation)
#       One GoogleTest program, test_<name>, and one ctest entry for all of it: a process builds
#       its OpenCL programs anew, so an entry per suite is much faster than one per case.
#
#       SHARDS 6: six entries, <name>_0 to _5, of a sixth of the cases each. For a program that
#       takes long: they run side by side, and a failure says sooner where it was.
#
#   weft_cli_test(NAME bad_scenes LABELS cli SCRIPT bad_scenes.sh)
#       A script that drives the program `weft`: .sh (bash), .py (the Python of `./dev test`) or a
#       folder or test_*.py file of pytest. It starts in an empty folder of its own and finds the
#       program in $WEFT, the project in $WEFT_ROOT, the built programs in $WEFT_BIN.
#
#   weft_oclgrind_test(NAME tablecloth COMMAND weft run ... --device opencl)
#       A command under oclgrind, which interprets the kernels and reports races (a wrong colouring
#       is one), reads of uninitialised memory and accesses out of bounds.
#
# With WEFT_OCLGRIND=ON, a weft_test() with label `kernels` or `determinism` has such an entry too,
# `<name>.oclgrind`. The interpreter is about a thousand times slower than a device, so
# OCLGRIND_FILTER <gtest filter> chooses its small cases, and OCLGRIND_FILTER none leaves it out.
#
# Label `threads` has what runs on several threads at a time: what the thread sanitizer looks at.
# TSAN_FILTER <gtest filter> leaves it what has several threads in it, of a test that has much else;
# it has four times as long. The targets `threads` and `oclgrind` build the programs of those entries
# alone, so that a sanitizer does not have to build everything.
#
# All take TIMEOUT <seconds> (default 300). Entries labelled `bench-smoke` run alone.

find_package(GTest REQUIRED)

set(WEFT_TEST_ENVIRONMENT
    XDG_CACHE_HOME=${PROJECT_BINARY_DIR}/cache          # not the user's caches
    ASAN_OPTIONS=strict_string_checks=1:detect_stack_use_after_return=1
    LSAN_OPTIONS=suppressions=${CMAKE_CURRENT_LIST_DIR}/sanitizers/lsan.txt:print_suppressions=0
    TSAN_OPTIONS=suppressions=${CMAKE_CURRENT_LIST_DIR}/sanitizers/tsan.txt:history_size=7
    UBSAN_OPTIONS=print_stacktrace=1)

add_custom_target(threads)
add_custom_target(oclgrind)

function(weft_test)
  cmake_parse_arguments(ARG "" "NAME;TIMEOUT;OCLGRIND_FILTER;TSAN_FILTER;SHARDS"
                        "LABELS;SOURCES;LIBS" ${ARGN})
  set(of_test "${WEFT_TEST_ENVIRONMENT}")
  if(WEFT_SANITIZE STREQUAL "thread" AND ARG_TSAN_FILTER)
    list(APPEND of_test GTEST_FILTER=${ARG_TSAN_FILTER})
  endif()
  add_executable(test_${ARG_NAME} ${ARG_SOURCES})
  target_link_libraries(test_${ARG_NAME} PRIVATE ${ARG_LIBS} weft::options weft::warnings
                                                 GTest::gtest_main)
  if(threads IN_LIST ARG_LABELS)
    add_dependencies(threads test_${ARG_NAME})
  endif()
  if(ARG_SHARDS)
    math(EXPR last "${ARG_SHARDS} - 1")
    foreach(shard RANGE ${last})
      add_test(NAME ${ARG_NAME}_${shard} COMMAND test_${ARG_NAME})
      weft_set_test_properties(${ARG_NAME}_${shard} "${ARG_LABELS}" "${ARG_TIMEOUT}")
      set_property(TEST ${ARG_NAME}_${shard} PROPERTY ENVIRONMENT
                   ${of_test} GTEST_TOTAL_SHARDS=${ARG_SHARDS} GTEST_SHARD_INDEX=${shard})
    endforeach()
  else()
    add_test(NAME ${ARG_NAME} COMMAND test_${ARG_NAME})
    weft_set_test_properties(${ARG_NAME} "${ARG_LABELS}" "${ARG_TIMEOUT}")
    set_property(TEST ${ARG_NAME} PROPERTY ENVIRONMENT ${of_test})
  endif()

  if(ARG_LABELS MATCHES "kernels|determinism" AND NOT ARG_OCLGRIND_FILTER STREQUAL "none")
    if(NOT ARG_OCLGRIND_FILTER)
      set(ARG_OCLGRIND_FILTER "*")
    endif()
    weft_oclgrind_test(NAME ${ARG_NAME} LABELS ${ARG_LABELS} TIMEOUT ${ARG_TIMEOUT}
                       COMMAND test_${ARG_NAME} --gtest_filter=${ARG_OCLGRIND_FILTER})
  endif()
endfunction()

function(weft_cli_test)
  cmake_parse_arguments(ARG "" "NAME;TIMEOUT;SCRIPT" "LABELS;ARGS" ${ARGN})
  get_filename_component(script ${ARG_SCRIPT} ABSOLUTE)
  if(script MATCHES "\\.sh$")
    set(command bash ${script})
  elseif(NOT WEFT_PYTHON)
    message(STATUS "Test ${ARG_NAME} left out: it needs WEFT_PYTHON (./dev test sets it)")
    return()
  elseif(IS_DIRECTORY ${script} OR script MATCHES "/test_[^/]*\\.py$")
    set(command ${WEFT_PYTHON} -m pytest -q -p no:cacheprovider ${script})
  else()
    set(command ${WEFT_PYTHON} ${script})
  endif()

  # ctest cannot empty a folder, so the entry begins with CMake doing so.
  set(folder ${PROJECT_BINARY_DIR}/tests/work/${ARG_NAME})
  file(MAKE_DIRECTORY ${folder})
  add_test(NAME ${ARG_NAME}
           COMMAND ${CMAKE_COMMAND} -DFOLDER=${folder}
                   -P ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/run_in_empty_folder.cmake
                   -- ${command} ${ARG_ARGS})
  weft_set_test_properties(${ARG_NAME} "${ARG_LABELS}" "${ARG_TIMEOUT}")
  set_property(TEST ${ARG_NAME} APPEND PROPERTY ENVIRONMENT
               WEFT=$<TARGET_FILE:weft> WEFT_ROOT=${PROJECT_SOURCE_DIR}
               WEFT_BIN=${CMAKE_RUNTIME_OUTPUT_DIRECTORY})
endfunction()

function(weft_oclgrind_test)
  if(NOT WEFT_OCLGRIND)
    return()
  endif()
  cmake_parse_arguments(ARG "" "NAME;TIMEOUT" "LABELS;COMMAND" ${ARGN})
  find_program(OCLGRIND oclgrind REQUIRED)
  list(POP_FRONT ARG_COMMAND program)
  if(TARGET ${program})
    add_dependencies(oclgrind ${program})
    set(program $<TARGET_FILE:${program}>)
  endif()
  add_test(NAME ${ARG_NAME}.oclgrind
           COMMAND ${OCLGRIND} --data-races --uninitialized --build-options -cl-opt-disable
                   ${program} ${ARG_COMMAND})
  weft_set_test_properties(${ARG_NAME}.oclgrind "${ARG_LABELS};oclgrind" "${ARG_TIMEOUT}")
  # oclgrind exits 0 whatever it finds: its text decides. A value that differs in its last bit is
  # no finding, since oclgrind divides with 1e-7 accuracy: so the program's own verdict
  # is not asked, only that it reached its end. Without -cl-opt-disable it meets instructions that
  # it does not know.
  set_tests_properties(${ARG_NAME}.oclgrind PROPERTIES
      PASS_REGULAR_EXPRESSION "suites? ran|1 test ran|state hash"
      FAIL_REGULAR_EXPRESSION
      "data race at|[Uu]ninitialized value|Invalid (read|write)|Oclgrind - Error|OCLGRIND FATAL ERROR|Aborted|SEGV")
endfunction()

function(weft_set_test_properties name labels timeout)
  if(NOT timeout)
    set(timeout 300)
  endif()
  if(WEFT_SANITIZE STREQUAL "thread")
    math(EXPR timeout "4 * ${timeout}")
  endif()
  set_tests_properties(${name} PROPERTIES LABELS "${labels}" TIMEOUT ${timeout}
                       ENVIRONMENT "${WEFT_TEST_ENVIRONMENT}")
  if(labels MATCHES "bench-smoke")
    set_tests_properties(${name} PROPERTIES RUN_SERIAL ON)
  endif()
endfunction()
