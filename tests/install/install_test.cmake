# cmake -DBUILD=... -DROOT=... -DWORK=... -DGENERATOR=... -DCOMPILER=... -DFLAGS=... -P install_test.cmake
# What somebody else would do with an installed Weft: the examples, the code of docs/library.md, and
# a project with a shared library of its own. All of it away from the tree: a header or a path of the
# source tree that slipped in would be found otherwise.
cmake_minimum_required(VERSION 3.23)

function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE result OUTPUT_VARIABLE output
                  ERROR_VARIABLE errors)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "failed (${result}): ${ARGV}\n${output}\n${errors}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

function(build name)
  run(${CMAKE_COMMAND} -S ${WORK}/${name} -B ${WORK}/${name}/build -G ${GENERATOR}
      -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_FLAGS=${FLAGS} -DCMAKE_PREFIX_PATH=${WORK}/prefix
      ${ARGN})
  run(${CMAKE_COMMAND} --build ${WORK}/${name}/build)
endfunction()

# Runs a program on several device lists: all must end in the same states.
function(expect_same_states program)
  set(expected "")
  foreach(devices cpu/1 cpu/2 opencl:0/1 cpu/1+opencl:0/1)
    run(${program} ${devices})
    string(REGEX MATCHALL "state [0-9a-f]+" states "${output}")
    if(NOT states)
      message(FATAL_ERROR "${program} ${devices} tells no state:\n${output}")
    elseif(expected AND NOT states STREQUAL expected)
      message(FATAL_ERROR "${program} ${devices}: ${states}, and elsewhere ${expected}")
    endif()
    set(expected "${states}")
  endforeach()
endfunction()

# The blocks of code that stand behind a line with a file's name in it.
function(copy_out document folder)
  file(READ ${document} text)
  foreach(file IN LISTS ARGN)
    string(FIND "${text}" "`${file}`" at)
    if(at EQUAL -1)
      message(FATAL_ERROR "${document} has no ${file}")
    endif()
    string(SUBSTRING "${text}" ${at} -1 rest)
    string(FIND "${rest}" "\n```" begin)
    math(EXPR begin "${begin} + 4")
    string(SUBSTRING "${rest}" ${begin} -1 rest)
    string(FIND "${rest}" "\n" begin)
    string(FIND "${rest}" "\n```" end)
    math(EXPR begin "${begin} + 1")
    math(EXPR length "${end} - ${begin} + 1")
    string(SUBSTRING "${rest}" ${begin} ${length} code)
    file(WRITE ${folder}/${file} "${code}")
  endforeach()
endfunction()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${WORK}/prefix/bin/weft --help)

# The public face, and nothing else.
file(GLOB_RECURSE headers RELATIVE ${WORK}/prefix/include ${WORK}/prefix/include/*)
list(SORT headers)
set(expected buffer cloth device error kernel launch runner schedule step trace version work)
list(TRANSFORM expected REPLACE "(.+)" "weft/\\1.h")
if(NOT headers STREQUAL expected)
  message(FATAL_ERROR "these headers are installed: ${headers}")
endif()

file(COPY ${ROOT}/examples DESTINATION ${WORK})
build(examples)
run(${WORK}/examples/build/schedule)
expect_same_states(${WORK}/examples/build/heat)
expect_same_states(${WORK}/examples/build/net)
expect_same_states(${WORK}/examples/build/cloth)

copy_out(${ROOT}/docs/library.md ${WORK}/rod CMakeLists.txt rod.h main.cpp)
build(rod)
expect_same_states(${WORK}/rod/build/rod)
copy_out(${ROOT}/docs/library.md ${WORK}/consumer again.cpp graph.cpp sheet.cpp)

# Kernels in a static and in a shared library, in the slowest kind of build; and every header alone.
file(COPY ${ROOT}/tests/install/consumer DESTINATION ${WORK})
build(consumer -DCMAKE_BUILD_TYPE=Debug)
run(${WORK}/consumer/build/graph)
run(${WORK}/consumer/build/sheet)
expect_same_states(${WORK}/consumer/build/through_static)
expect_same_states(${WORK}/consumer/build/through_shared)
find_program(NM nm)
if(NM AND NOT APPLE)
  run(${NM} -DC --defined-only ${WORK}/consumer/build/libhalve_shared.so)
  if(output MATCHES " [TDB] weft::[^\n]*")
    message(FATAL_ERROR "a shared library hands on Weft's own: ${CMAKE_MATCH_0}")
  endif()
endif()
