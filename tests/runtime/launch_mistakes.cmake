# cmake -DCOMPILER=<c++> -DROOT=<project> -P launch_mistakes.cmake
# Compiles launch_mistakes.cpp once per mistake: only that without one may compile.

foreach(mistake RANGE 0 12)
  execute_process(
    COMMAND ${COMPILER} -std=c++20 -fsyntax-only -I${ROOT} -DMISTAKE=${mistake}
            ${CMAKE_CURRENT_LIST_DIR}/launch_mistakes.cpp
    RESULT_VARIABLE result ERROR_VARIABLE messages)
  if(mistake EQUAL 0 AND NOT result EQUAL 0)
    message(FATAL_ERROR "A correct launch does not compile:\n${messages}")
  elseif(mistake GREATER 0 AND result EQUAL 0)
    message(FATAL_ERROR "Mistake ${mistake} of launch_mistakes.cpp compiles")
  elseif(mistake GREATER 0 AND NOT messages MATCHES
         "one argument per parameter|this parameter takes a Buffer|float for float, int for int|static assertion failed|discards qualifiers|invalid conversion|deleted function")
    message(FATAL_ERROR "Mistake ${mistake} fails for another reason:\n${messages}")
  endif()
endforeach()
