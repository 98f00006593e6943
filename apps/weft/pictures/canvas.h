#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

namespace weft {

struct Colour {
    std::uint8_t red = 0;
    std::uint8_t green = 0;
    std::uint8_t blue = 0;
};

struct Point {
    double x = 0.0;
    double y = 0.0;
};

enum class Anchor { kStart, kMiddle, kEnd };

/// A picture to draw on, x to the right, y down, in pixels of a screen.
class Canvas {
public:
    virtual ~Canvas() = default;

    /// note: what a viewer may show when the mouse is over it; may be empty.
    virtual void rectangle(Point corner, double width, double height, Colour fill,
                           const std::string& note) = 0;
    virtual void line(Point from, Point to, Colour colour, double width, bool dashed) = 0;
    virtual void triangle(const std::array<Point, 3>& corners, Colour fill) = 0;
    /// position: of the baseline. About 0.6 * size per letter.
    virtual void text(Point position, const std::string& text, double size, Anchor anchor,
                      Colour colour) = 0;

    /// The file's bytes; nothing can be drawn afterwards.
    virtual std::string finish() = 0;
};

std::unique_ptr<Canvas> make_svg_canvas(double width, double height);
/// Null if weft was built without cairo. Drawn at twice the size, for sharp text.
std::unique_ptr<Canvas> make_png_canvas(double width, double height);

}  // namespace weft
