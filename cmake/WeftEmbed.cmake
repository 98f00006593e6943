# weft_embed_kernels(<output.cpp> <headers...>): makes a source that holds the text of the headers
# (paths from the project's root), for OpenCL to compile at run time.

function(weft_embed_kernels output)
  set(paths ${ARGN})
  list(TRANSFORM paths PREPEND ${PROJECT_SOURCE_DIR}/)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -D "OUTPUT=${output}" -D "ROOT=${PROJECT_SOURCE_DIR}" -D
            "HEADERS=${ARGN}" -P ${PROJECT_SOURCE_DIR}/cmake/EmbedKernels.cmake
    DEPENDS ${paths} ${PROJECT_SOURCE_DIR}/cmake/EmbedKernels.cmake
    COMMENT "Embedding kernels"
    VERBATIM)
endfunction()
