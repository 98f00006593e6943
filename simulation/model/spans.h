#pragma once

#include <map>
#include <span>
#include <vector>

#include "simulation/model/load_paths.h"

namespace weft {

/// Finds cloth that pins hold on several sides, so that it bears its weight between them by being
/// stretched. Pins that move may let it hang loose at any time: only those that stay count.
class Spans {
public:
    /// down: along gravity, of length 1. `all` must outlive it.
    Spans(const Gathered& all, Vec3 down);

    /// Says so of a path, if it has any.
    /// part    all of its vertices
    /// masses  of its bodies, by their numbers [kg]
    void add_to(LoadPath& path, std::span<const int> part,
                const std::map<std::size_t, double>& masses);

private:
    struct Cloth;
    Cloth cloth_of(std::span<const int> part, const std::map<std::size_t, double>& masses) const;
    template <class Use>
    void for_each_triangle(const Cloth& cloth, std::span<const int> part, const Use& use);
    double resistance_of(const Cloth& cloth, Vec3 along);

    const Gathered& all_;
    Vec3 down_;
    std::vector<char> moves_;         ///< [vertices] 1: a pin leads it
    std::vector<char> is_here_;       ///< [vertices] of use in for_each_triangle()
    Vec3 along_;                      ///< what the resistance is along
    std::vector<double> resistance_;  ///< [vertices] [J]
};

/// The longest way straight from one of the held vertices to another that a loose one lies about
/// in the middle of, seen along gravity; of those through the same one, the shortest. 0: none, or
/// the loose ones, on the whole, are not between the held ones.
/// down: of length 1
Vec3 widest_span(std::span<const Vec3> rest, std::span<const int> held, std::span<const int> loose,
                 Vec3 down);

}  // namespace weft
