// A net of springs that falls, and is stretched: knots are a type of this program's own.
//   net [DEVICES]
#include <weft/runner.h>

#include <cmath>
#include <cstdio>

#include "net.h"

namespace {

constexpr int kAcross = 96, kAlong = 128, kKnots = kAcross * kAlong;
constexpr float kStep = 1e-3f, kGravity = -10.0f, kRest = 0.1f, kStiffness = 40.0f;

struct Net {
    weft::Buffer<net::Knot> now{"now", kKnots}, next{"next", kKnots};
    weft::Buffer<int> neighbours{"neighbours", 4 * kKnots};
    weft::Buffer<int> begin{"rows", kAlong + 1};  // a strip is a row of knots
    weft::Segments rows = weft::even_strips(begin, kKnots);
    weft::StripWork work{kAlong};

    Net() {
        for (int k = 0; k < kKnots; ++k) {
            const int row = k / kAcross, column = k % kAcross;
            now[k] = {1.2f * kRest * column, 0.0f, kRest * row, 0.0f, 0.0f, 0.0f, 100.0f};
            const int beside[] = {column > 0 ? k - 1 : k, column + 1 < kAcross ? k + 1 : k,
                                  row > 0 ? k - kAcross : k, row + 1 < kAlong ? k + kAcross : k};
            for (int n = 0; n < 4; ++n) neighbours[n * kKnots + k] = beside[n];
        }
        add("there", now, next);
        add("back", next, now);
    }

    void add(const char* name, weft::Buffer<net::Knot>& from, weft::Buffer<net::Knot>& to) {
        work.add(name, weft::launch(net::swing, rows, from, to, neighbours, kKnots, kStiffness,
                                    kRest, kStep, kGravity))
            .reads(from, rows, 1)
            .reads(neighbours)
            .updates(to, rows);
    }

    double height() const {
        double sum = 0.0;
        for (const net::Knot& knot : now.span()) sum += knot.y;
        return sum / kKnots;
    }
    double width() const { return now[kAcross - 1].x - now[0].x; }
};

}  // namespace

int main(int count, char** arguments) {
    Net net;
    const double before = net.width();
    weft::Runner runner(net.work, {.devices = count > 1 ? arguments[1] : "hybrid"});
    constexpr int kFrames = 10, kSwings = 10;
    for (int frame = 0; frame < kFrames; ++frame) runner.advance(kSwings);

    // Nothing holds the net, and springs pull both ends alike: it falls as one stone would.
    const int n = 2 * kFrames * kSwings;
    const double expected = 0.5 * kGravity * kStep * kStep * n * (n + 1);
    std::printf("fell to %.5f m, expected %.5f m; %.2f m wide, before %.2f m; state %s\n",
                net.height(), expected, net.width(), before, runner.state_hash().c_str());
    return std::abs(net.height() - expected) < 1e-4 && net.width() < before ? 0 : 1;
}
