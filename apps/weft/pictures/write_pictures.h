#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "apps/weft/output/output_file.h"
#include "apps/weft/pictures/canvas.h"

namespace weft {

/// folder/name.svg, and name.png where there is cairo. Says what was written.
template <class Picture>
std::string write_pictures(const std::filesystem::path& folder, const std::string& name,
                           const Picture& picture) {
    const auto write = [&](std::unique_ptr<Canvas> canvas, const std::string& file) {
        picture.draw(*canvas);
        write_output(folder / file, canvas->finish());
    };
    write(make_svg_canvas(picture.width(), picture.height()), name + ".svg");
    auto png = make_png_canvas(picture.width(), picture.height());
    if (!png) return fmt::format("{0}.svg (no {0}.png: this weft was built without cairo)", name);
    write(std::move(png), name + ".png");
    return fmt::format("{0}.svg, {0}.png", name);
}

}  // namespace weft
