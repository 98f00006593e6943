#pragma once

#include <set>
#include <string>
#include <vector>

#include "apps/weft/pictures/canvas.h"

namespace weft {

/// A map of cells in colours, over two quantities in equal steps.
class MapPanel {
public:
    struct Cell {
        double across = 0.0;
        double up = 0.0;
        Colour colour;
        std::string note;
        bool is_crossed_out = false;
    };
    /// In pixels.
    static constexpr double kSize = 200.0;
    static constexpr double kText = 12.0;

    std::string title;
    std::string across;       ///< what it is
    bool has_labels = false;  ///< of what goes up: the first of a row has
    std::vector<Cell> cells;

    /// corner: upper left, of the cells
    void draw(Canvas& canvas, Point corner) const;
};

/// Colours with names from left to right; gives where the next one would begin.
double draw_colour_key(Canvas& canvas, double left,
                       const std::vector<std::pair<std::string, Colour>>& key);

}  // namespace weft
