// Stands in for cairo_canvas.cpp where there is no cairo.
#include "apps/weft/pictures/canvas.h"

namespace weft {

std::unique_ptr<Canvas> make_png_canvas(double, double) { return nullptr; }

}  // namespace weft
