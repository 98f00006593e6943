#pragma once

#include "tests/runtime/library/own_kernels.h"
#include "weft/runner.h"

namespace weft::test {

/// A rod of cells of a type of its own, in strips.
struct OwnWork {
    static constexpr int kCells = 1000, kStrips = 12, kZones = 3, kInstances = 8;

    Buffer<own::Cell> now{"now", kCells}, next{"next", kCells};
    Buffer<float> losses{"losses", kZones* kInstances};
    Buffer<int> begin{"strips", kStrips + 1};
    Segments strips = even_strips(begin, kCells);
    StripWork work{kStrips};

    OwnWork() {
        for (int c = 0; c < kCells; ++c) {
            const auto at = static_cast<std::size_t>(c);
            now[at].heat = static_cast<float>((c * 37) % 101);
            now[at].zone = next[at].zone = c % kZones;
        }
        for (std::size_t l = 0; l < losses.count(); ++l) {
            losses[l] = 0.001f * static_cast<float>(l % 7);
        }
        add("there", now, next);
        add("back", next, now);
    }

    Launch spread(Buffer<own::Cell>& from, Buffer<own::Cell>& to) {
        return launch(own::spread, strips, from, to, losses, kCells, 0.2f, kZones, kInstance);
    }
    void add(const char* name, Buffer<own::Cell>& from, Buffer<own::Cell>& to) {
        work.add(name, spread(from, to))
            .reads(from, strips, 1)
            .reads_by_instance(losses, kZones)
            .updates(to, strips);
    }
};

}  // namespace weft::test
