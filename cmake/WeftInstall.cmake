# `cmake --install` and find_package(weft): the libraries (installed by weft_library), the program,
# the public headers and the package files. tests/install/ tries all of it from outside the tree.

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/weft)

install(TARGETS weft_options weft_warnings EXPORT weftTargets COMPONENT development)
set_target_properties(weft_options PROPERTIES EXPORT_NAME options)
set_target_properties(weft_warnings PROPERTIES EXPORT_NAME warnings)
if(TARGET weft)
  install(TARGETS weft RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
endif()
install(EXPORT weftTargets NAMESPACE weft:: DESTINATION ${package_dir} COMPONENT development)

# Those of weft/ that the components have, each with all that it needs of the tree in it.
set(public_headers version schedule)
set(weft_built_components scheduler)
if(NOT WEFT_COMPONENTS STREQUAL "scheduler")
  list(APPEND public_headers error kernel buffer launch step device work trace runner)
  list(APPEND weft_built_components kernels runtime)
endif()
if(WEFT_COMPONENTS MATCHES "^(all|simulation)$")
  list(APPEND public_headers cloth)
  list(APPEND weft_built_components simulation)
endif()
install(CODE "set(WEFT_SOURCE \"${PROJECT_SOURCE_DIR}\")
set(WEFT_BINARY \"${PROJECT_BINARY_DIR}\")
set(WEFT_HEADERS \"${public_headers}\")
set(WEFT_INCLUDES \"${CMAKE_INSTALL_INCLUDEDIR}/weft\")" COMPONENT development)
install(SCRIPT ${CMAKE_CURRENT_LIST_DIR}/InstallHeaders.cmake COMPONENT development)

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/weftConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/weftConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/weftConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/weftConfig.cmake ${PROJECT_BINARY_DIR}/weftConfigVersion.cmake
              ${CMAKE_CURRENT_LIST_DIR}/FindLibdeflate.cmake
              ${CMAKE_CURRENT_LIST_DIR}/WeftKernels.cmake
              ${CMAKE_CURRENT_LIST_DIR}/EmbedKernels.cmake
        DESTINATION ${package_dir} COMPONENT development)
