# cmake -DBUILD=... -DCONSUMER=... -DWORK=... -DGENERATOR=... -DCOMPILER=... -P install_test.cmake

function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "failed (${result}): ${ARGV}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
# Away from the tree: a header or a path of the source tree that slipped in would be found otherwise.
file(COPY ${CONSUMER}/ DESTINATION ${WORK}/source)
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${WORK}/source -B ${WORK}/build -G ${GENERATOR}
    -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_FLAGS=${FLAGS} -DCMAKE_PREFIX_PATH=${WORK}/prefix)
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/scheduler_alone)
run(${WORK}/build/runtime_alone)
run(${WORK}/build/cloth)
run(${WORK}/prefix/bin/weft --help)
