#include <fmt/format.h>

#include "apps/weft/pictures/canvas.h"
#include "simulation/output/xml_text.h"

namespace weft {

namespace {

std::string hex(Colour c) {
    return fmt::format("#{:02x}{:02x}{:02x}", int{c.red}, int{c.green}, int{c.blue});
}

/// A hundredth of a pixel is enough.
std::string number(double value) {
    std::string text = fmt::format("{:.2f}", value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
}

class SvgCanvas final : public Canvas {
public:
    SvgCanvas(double width, double height) {
        text_ = fmt::format(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
            "viewBox=\"0 0 {0} {1}\" font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\">\n",
            number(width), number(height));
        rectangle({0.0, 0.0}, width, height, {255, 255, 255}, "");
    }

    void rectangle(Point corner, double width, double height, Colour fill,
                   const std::string& note) override {
        const std::string title =
            note.empty() ? "/>" : fmt::format("><title>{}</title></rect>", xml_text(note));
        text_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"{}\n",
                             number(corner.x), number(corner.y), number(width), number(height),
                             hex(fill), title);
    }

    void line(Point from, Point to, Colour colour, double width, bool dashed) override {
        text_ += fmt::format(
            "<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" stroke=\"{}\" stroke-width=\"{}\"{}/>\n",
            number(from.x), number(from.y), number(to.x), number(to.y), hex(colour), number(width),
            dashed ? " stroke-dasharray=\"5 4\"" : "");
    }

    void triangle(const std::array<Point, 3>& corners, Colour fill) override {
        text_ += "<polygon points=\"";
        for (const Point& p : corners) text_ += number(p.x) + "," + number(p.y) + " ";
        text_.back() = '"';
        text_ += fmt::format(" fill=\"{}\"/>\n", hex(fill));
    }

    void text(Point position, const std::string& text, double size, Anchor anchor,
              Colour colour) override {
        constexpr const char* kAnchors[] = {"start", "middle", "end"};
        text_ += fmt::format(
            "<text x=\"{}\" y=\"{}\" font-size=\"{}\" text-anchor=\"{}\" fill=\"{}\">{}</text>\n",
            number(position.x), number(position.y), number(size),
            kAnchors[static_cast<int>(anchor)], hex(colour), xml_text(text));
    }

    std::string finish() override { return std::move(text_) + "</svg>\n"; }

private:
    std::string text_;
};

}  // namespace

std::unique_ptr<Canvas> make_svg_canvas(double width, double height) {
    return std::make_unique<SvgCanvas>(width, height);
}

}  // namespace weft
