# weft_add_kernels(<target> <headers...> [ROOT <folder>])
#
# Compiles the kernels of these headers (WEFT_KERNEL, weft/kernel.h) for all targets, embeds their
# text for OpenCL, and registers both when the program starts. To be called where the target is
# made:
#
#   add_executable(heat main.cpp)
#   target_link_libraries(heat PRIVATE weft::runtime)
#   weft_add_kernels(heat diffuse.h)
#
# Give every header of yours that a kernel includes, too. With ROOT, messages of OpenCL compilers
# name the headers from that folder on.
#
# Kernels are compiled with strict arithmetic and -O3, whatever the target's other sources are; by
# -O1 those that take much longer otherwise: with sanitizers half an hour, and packs for x86-64
# without AVX2, which choose lanes by branches, five times as long.

include_guard()

function(weft_add_kernels target)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "" "ROOT" "")
  if(NOT TARGET ${target})
    message(FATAL_ERROR "weft_add_kernels: there is no target '${target}'")
  endif()
  if(NOT ARG_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "weft_add_kernels(${target}): name the headers that hold the kernels")
  endif()
  _weft_kernel_paths("${ARG_ROOT}" "${ARG_UNPARSED_ARGUMENTS}")
  string(MAKE_C_IDENTIFIER "weft_kernels_${target}" anchor)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/${target}.kernels)
  set(script ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/EmbedKernels.cmake)

  # -fno-math-errno: square roots become instructions; it changes no bit of a result.
  # -Wno-psabi: packs never cross a file's border, so how they would be passed does not matter.
  set(level -O3)
  if(WEFT_SANITIZE)
    set(level -O1)
  endif()
  set(strict ${level} -fno-fast-math -ffp-contract=off -fno-math-errno)
  set(anchors "")
  _weft_kernel_sources(scalar "#define WEFT_SCALAR_TARGET" "${strict}")
  if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    _weft_packed_sources(packed kPacked 8 "")
  else()
    _weft_packed_sources(packed kPacked 8 "-O1")
    _weft_packed_sources(packed_avx2 kPackedAvx2 8 "-mavx2")
    if(NOT WEFT_SANITIZE)     # whose code that runs when a program starts would need AVX-512, too
      _weft_packed_sources(packed_avx512 kPackedAvx512 16
                           "-mavx512f;-mavx512vl;-mavx512dq;-mavx512bw")
    endif()
  endif()
  _weft_kernel_text()

  # Nothing in a program names these files, so a linker would leave them in a static library.
  get_target_property(type ${target} TYPE)
  if(type STREQUAL "STATIC_LIBRARY")
    set(prefix "$<$<PLATFORM_ID:Darwin>:_>")
    target_link_options(${target} INTERFACE "LINKER:-u,${prefix}${anchor}")
  endif()
  target_compile_features(${target} PRIVATE cxx_std_20)
  if(NOT target STREQUAL "weft_kernels")
    target_link_libraries(${target} PRIVATE weft::kernels)
  endif()
endfunction()

# names: as messages have them; paths: where they are; folders: of these, and
# includes_<folder>: lines of C++.
macro(_weft_kernel_paths root headers)
  set(names "")
  set(paths "")
  set(folders "")
  foreach(header IN ITEMS ${headers})
    get_filename_component(path ${header} ABSOLUTE)
    if(NOT EXISTS ${path})
      message(FATAL_ERROR "weft_add_kernels(${target}): there is no header ${path}")
    endif()
    set(name ${path})
    if(NOT "${root}" STREQUAL "")
      file(RELATIVE_PATH name ${root} ${path})
    endif()
    list(APPEND names ${name})
    list(APPEND paths ${path})
    if(NOT name MATCHES "kernels/platform")
      get_filename_component(of ${path} DIRECTORY)
      string(MAKE_C_IDENTIFIER "${of}" of)
      if(NOT of IN_LIST folders)
        list(APPEND folders ${of})
        set(includes_${of} "")
      endif()
      string(APPEND includes_${of} "#include \"${name}\"\n")
    endif()
  endforeach()
endmacro()

# target_name: of kernels/registry.h; lanes: of its packs
macro(_weft_packed_sources variant target_name lanes flags)
  string(CONCAT definitions "#define WEFT_PACKED_TARGET ${variant}\n"
                "#define WEFT_PACKED_ID Target::${target_name}\n"
                "#define WEFT_PACKED_LANES ${lanes}")
  _weft_kernel_sources(${variant} "${definitions}"
                       "${strict};-fno-trapping-math;-Wno-psabi;${flags}")
endmacro()

# A source per folder of headers: a change compiles that folder anew, not everything. A kernel that
# several folders include is compiled in each and linked once, as any inline function.
macro(_weft_kernel_sources variant definitions flags)
  set(number 0)
  foreach(of IN LISTS folders)
    set(symbol ${anchor}_${variant}_${number})
    set(file ${folder}/${variant}_${number}.cpp)
    file(CONFIGURE OUTPUT ${file} @ONLY CONTENT "// Made by weft_add_kernels().
${definitions}
${includes_${of}}
extern \"C\" {
extern const int ${symbol};
const int ${symbol} = 0;
}
")
    target_sources(${target} PRIVATE ${file})
    set_source_files_properties(${file} TARGET_DIRECTORY ${target}
                                PROPERTIES COMPILE_OPTIONS "${flags}" SKIP_PRECOMPILE_HEADERS ON
                                           SKIP_UNITY_BUILD_INCLUSION ON)
    list(APPEND anchors ${symbol})
    math(EXPR number "${number} + 1")
  endforeach()
endmacro()

macro(_weft_kernel_text)
  set(file ${folder}/text.cpp)
  add_custom_command(
    OUTPUT ${file}
    COMMAND ${CMAKE_COMMAND} -D "OUTPUT=${file}" -D "NAMES=${names}" -D "PATHS=${paths}" -D
            "ANCHOR=${anchor}" -D "KEEP=${anchors}" -P ${script}
    DEPENDS ${paths} ${script}
    COMMENT "Embedding kernels of ${target}"
    VERBATIM)
  target_sources(${target} PRIVATE ${file})
endmacro()
