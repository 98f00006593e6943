# weft_library(<folder> SOURCES <files...> [PUBLIC <targets...>] [PRIVATE <targets...>])
#
# The library of one top-level folder: target weft_<folder>, for others weft::<folder>. Call it from
# the folder's CMakeLists.txt:
#
#   find_package(TBB REQUIRED)
#   weft_library(runtime
#     SOURCES device.cpp tbb/tbb_device.cpp
#     PUBLIC  weft::kernels weft::scheduler     # what our headers include
#     PRIVATE TBB::tbb)                         # what only our sources include
#   target_sources(weft_runtime PRIVATE ...)    # more files, from this or a sub-folder's list
#
# It adds weft::options, weft::warnings and the include folder: in the tree the project's root; after
# installation only the public headers are there, <weft/...> (WeftInstall.cmake). The library is
# installed. A package that it uses, PUBLIC or PRIVATE, is also a find_dependency() in
# weftConfig.cmake.in: a static library hands on what it links. One that is headers only is linked
# as $<BUILD_INTERFACE:...>, and nobody else needs it.
#
# Symbols are hidden: a shared library of somebody else's that has Weft in it hands on none of them.

include(GNUInstallDirs)

function(weft_library folder)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  set(target weft_${folder})
  add_library(${target} STATIC ${ARG_SOURCES})
  add_library(weft::${folder} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${folder} POSITION_INDEPENDENT_CODE ON
                        CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  target_include_directories(${target} PUBLIC
      "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR};${PROJECT_BINARY_DIR}/include>"
      $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(${target}
      PUBLIC weft::options ${ARG_PUBLIC}
      PRIVATE weft::warnings ${ARG_PRIVATE})

  install(TARGETS ${target} EXPORT weftTargets COMPONENT development)
endfunction()
