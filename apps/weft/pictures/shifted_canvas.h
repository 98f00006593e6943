#pragma once

#include "apps/weft/pictures/canvas.h"

namespace weft {

/// A part of another canvas, so far from its left border.
class ShiftedCanvas final : public Canvas {
public:
    ShiftedCanvas(Canvas& whole, double right) : whole_(whole), right_(right) {}

    void rectangle(Point corner, double width, double height, Colour fill,
                   const std::string& note) override {
        whole_.rectangle(moved(corner), width, height, fill, note);
    }
    void line(Point from, Point to, Colour colour, double width, bool dashed) override {
        whole_.line(moved(from), moved(to), colour, width, dashed);
    }
    void triangle(const std::array<Point, 3>& corners, Colour fill) override {
        whole_.triangle({moved(corners[0]), moved(corners[1]), moved(corners[2])}, fill);
    }
    void text(Point position, const std::string& text, double size, Anchor anchor,
              Colour colour) override {
        whole_.text(moved(position), text, size, anchor, colour);
    }
    std::string finish() override { return {}; }

private:
    Point moved(Point p) const { return {p.x + right_, p.y}; }

    Canvas& whole_;
    double right_;
};

}  // namespace weft
