# Script behind weft_embed_kernels(): OUTPUT, ROOT, HEADERS (a list).

set(entries "")
set(delimiter "weft_source")
foreach(header IN LISTS HEADERS)
  file(READ ${ROOT}/${header} text)
  string(APPEND entries "    {\"${header}\", R\"${delimiter}(${text})${delimiter}\"},\n")
endforeach()
list(LENGTH HEADERS count)
file(WRITE ${OUTPUT} "// Made by cmake/EmbedKernels.cmake.
#include \"kernels/sources.h\"

namespace weft::kernels {
namespace {
constexpr SourceFile kFiles[${count}] = {
${entries}};
}

std::span<const SourceFile> source_files() { return kFiles; }
}
")
