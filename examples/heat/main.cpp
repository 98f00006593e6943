// The heat equation on a square whose border is held at 0, on any devices:  heat [DEVICES [TRACE]]
// Begins with sin(pi x) sin(pi y), which falls off as exp(-2 pi^2 t): so the error is known.
#include <weft/runner.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "heat.h"

namespace {

constexpr double kEnd = 0.05;  // when to look

/// A square of n * n cells between its borders, in strips of rows.
struct Square {
    int n, width, strips;
    weft::Buffer<float> now{"now", cells()}, next{"next", cells()}, rate{"rate", cells()};
    weft::Buffer<int> begin{"rows", static_cast<std::size_t>(strips) + 1};
    weft::Segments rows{&begin, 0, 1, strips};
    weft::StripWork work{strips};

    explicit Square(int size) : n(size), width(size + 2), strips(size < 32 ? 4 : size / 8) {
        for (int s = 0; s <= strips; ++s) begin[s] = width * (1 + n * s / strips);
        for (int row = 1; row <= n; ++row) {
            for (int column = 1; column <= n; ++column) {
                now[row * width + column] = static_cast<float>(exact(row, column, 0.0));
                rate[row * width + column] = 0.2f;
            }
        }
        add("there", now, next);
        add("back", next, now);
    }

    /// Each strip reads a strip on either side, too.
    void add(const char* name, weft::Buffer<float>& from, weft::Buffer<float>& to) {
        work.add(name, weft::launch(heat::diffuse, rows, from, to, rate, width))
            .reads(from, rows, 1)
            .reads(rate, rows)
            .updates(to, rows);
    }

    std::size_t cells() const { return static_cast<std::size_t>(width) * width; }
    double spacing() const { return 1.0 / (n + 1); }
    /// There and back, of the length that the rate says.
    int steps() const {
        return static_cast<int>(std::lround(kEnd / (0.4 * spacing() * spacing())));
    }
    double time() const { return steps() * 0.4 * spacing() * spacing(); }

    double exact(int row, int column, double t) const {
        constexpr double kPi = std::numbers::pi;
        return std::sin(kPi * row * spacing()) * std::sin(kPi * column * spacing()) *
               std::exp(-2.0 * kPi * kPi * t);
    }
    /// The largest of all cells.
    double error() const {
        double most = 0.0;
        for (int row = 1; row <= n; ++row) {
            for (int column = 1; column <= n; ++column) {
                const double difference = now[row * width + column] - exact(row, column, time());
                most = std::max(most, std::abs(difference));
            }
        }
        return most;
    }
};

}  // namespace

int main(int count, char** arguments) {
    weft::RunnerOptions options;
    if (count > 1) options.devices = arguments[1];
    double before = 0.0;
    bool converges = true;
    for (const int n : {15, 31, 63}) {
        Square square(n);
        if (count > 2 && n == 63) options.trace = arguments[2];
        weft::Runner runner(square.work, options);
        for (int left = square.steps(); left > 0; left -= 50) runner.advance(std::min(left, 50));
        runner.finish();
        std::printf("%d cells across: error %.2e, state %s\n", n, square.error(),
                    runner.state_hash().c_str());
        // Twice as many cells: a quarter of the error.
        converges = converges && (before == 0.0 || square.error() < before / 3.5);
        before = square.error();
    }
    return converges ? 0 : 1;
}
