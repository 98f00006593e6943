#include "weft/version.h"

namespace weft {

const char* library_version() { return WEFT_VERSION_TEXT; }

}  // namespace weft
