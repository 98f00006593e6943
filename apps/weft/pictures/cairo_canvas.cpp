#include <cairo.h>

#include <cmath>
#include <stdexcept>

#include "apps/weft/pictures/canvas.h"

namespace weft {

namespace {

constexpr double kScale = 2.0;

class CairoCanvas final : public Canvas {
public:
    CairoCanvas(double width, double height)
        : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, pixels(width), pixels(height))),
          cairo_(cairo_create(surface_)) {
        check(cairo_status(cairo_));
        cairo_scale(cairo_, kScale, kScale);
        cairo_select_font_face(cairo_, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                               CAIRO_FONT_WEIGHT_NORMAL);
        use({255, 255, 255});
        cairo_paint(cairo_);
    }
    ~CairoCanvas() override {
        cairo_destroy(cairo_);
        cairo_surface_destroy(surface_);
    }
    CairoCanvas(const CairoCanvas&) = delete;
    CairoCanvas& operator=(const CairoCanvas&) = delete;

    void rectangle(Point corner, double width, double height, Colour fill,
                   const std::string&) override {
        use(fill);
        cairo_rectangle(cairo_, corner.x, corner.y, width, height);
        cairo_fill(cairo_);
    }

    void line(Point from, Point to, Colour colour, double width, bool dashed) override {
        constexpr double kDashes[] = {5.0, 4.0};
        use(colour);
        cairo_set_dash(cairo_, kDashes, dashed ? 2 : 0, 0.0);
        cairo_set_line_width(cairo_, width);
        cairo_move_to(cairo_, from.x, from.y);
        cairo_line_to(cairo_, to.x, to.y);
        cairo_stroke(cairo_);
    }

    void triangle(const std::array<Point, 3>& corners, Colour fill) override {
        use(fill);
        for (const Point& p : corners) cairo_line_to(cairo_, p.x, p.y);
        cairo_close_path(cairo_);
        cairo_fill(cairo_);
    }

    void text(Point position, const std::string& text, double size, Anchor anchor,
              Colour colour) override {
        use(colour);
        cairo_set_font_size(cairo_, size);
        cairo_text_extents_t extents;
        cairo_text_extents(cairo_, text.c_str(), &extents);
        constexpr double kShare[] = {0.0, 0.5, 1.0};
        cairo_move_to(cairo_, position.x - kShare[static_cast<int>(anchor)] * extents.x_advance,
                      position.y);
        cairo_show_text(cairo_, text.c_str());
    }

    std::string finish() override {
        std::string bytes;
        const auto append = [](void* to, const unsigned char* data, unsigned length) {
            static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(data), length);
            return CAIRO_STATUS_SUCCESS;
        };
        check(cairo_status(cairo_));
        check(cairo_surface_write_to_png_stream(surface_, append, &bytes));
        return bytes;
    }

private:
    static int pixels(double length) { return static_cast<int>(std::ceil(length * kScale)); }

    static void check(cairo_status_t status) {
        if (status == CAIRO_STATUS_SUCCESS) return;
        throw std::runtime_error(std::string("cannot draw: ") + cairo_status_to_string(status));
    }

    void use(Colour c) {
        cairo_set_source_rgb(cairo_, c.red / 255.0, c.green / 255.0, c.blue / 255.0);
    }

    cairo_surface_t* surface_;
    cairo_t* cairo_;
};

}  // namespace

std::unique_ptr<Canvas> make_png_canvas(double width, double height) {
    return std::make_unique<CairoCanvas>(width, height);
}

}  // namespace weft
