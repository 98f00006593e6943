# Script behind weft_add_kernels(): writes OUTPUT, a source that holds the text of the headers PATHS
# under their NAMES, and hands it to the registry. ANCHOR: a symbol that makes a linker keep this
# file, and with it those that define the symbols KEEP. Without an anchor, the text is what
# language_sources() gives instead.

set(entries "")
set(delimiter "weft_source")
foreach(name path IN ZIP_LISTS NAMES PATHS)
  file(READ ${path} text)
  string(APPEND entries "    {\"${name}\", R\"${delimiter}(${text})${delimiter}\"},\n")
endforeach()
list(LENGTH NAMES count)

set(source "// Made by weft's EmbedKernels.cmake.
#include <weft/kernel.h>

namespace {
constexpr weft::kernels::SourceFile kFiles[${count}] = {
${entries}};
")
if(ANCHOR)
  string(APPEND source "[[maybe_unused]] const bool kAdded = weft::kernels::add_sources(kFiles);\n}\n\nextern \"C\" {\n")
  set(list "")
  foreach(symbol IN LISTS KEEP)
    string(APPEND source "extern const int ${symbol};\n")
    string(APPEND list "&${symbol}, ")
  endforeach()
  string(APPEND source "extern const int* const ${ANCHOR}[];
const int* const ${ANCHOR}[] = {${list}};
}
")
else()
  string(APPEND source "}

std::span<const weft::kernels::SourceFile> weft::kernels::language_sources() { return kFiles; }
")
endif()
file(WRITE ${OUTPUT} "${source}")
