#pragma once

#include <array>
#include <vector>

#include "simulation/contact/pairs.h"
#include "simulation/contact/patch_groups.h"
#include "tests/simulation/contact/contact_meshes.h"

namespace weft::test {

/// What a pair is to be found as; kEither: in double precision it is too near to a limit to tell.
enum class Verdict { kNone, kPair, kPushing, kEither };

/// Everything against everything, in double precision and by the definitions.
class PairOracle {
public:
    PairOracle(const ContactMesh& mesh, const Surface& surface, const PairSettings& settings);

    Verdict vertex_triangle(int vertex, int triangle) const;
    Verdict edge_edge(int edge, int other) const;
    /// How many groups of patches need no look among themselves.
    int flat_groups() const;

private:
    struct Distance {
        double d = 1e30;
        double on_a_side = 1e30;  ///< of a triangle, where that is farther
        Vec3 way{};
        std::vector<double> weights;
    };
    struct Patch {
        bool flat = false;
        bool near_limit = false;  ///< of being flat
        Vec3 mean{};
    };

    Vec3 at(int vertex) const;
    double reach(int vertex) const;
    Distance to_triangle(int vertex, const std::array<int, 3>& t) const;
    Distance between(int edge, int other) const;
    Patch patch(int p) const;
    Patch group(int g) const;
    /// Whether all of these are flat, and face one way by that cosine.
    static Verdict is_sheet(const std::array<Patch, 3>& parts, double cosine);
    /// Whether these patches are looked at together.
    Verdict near(int p, int q) const;
    template <class A, class B>
    bool share_a_knot(const A& a, const B& b) const;
    template <class A, class B>
    bool boxes_meet(const A& a, const B& b) const;
    Verdict verdict(double d, double reaches, Verdict pushes) const;
    Verdict pushes(int vertex, int triangle, const Distance& d) const;

    const ContactMesh& mesh_;
    const Surface& surface_;
    PairSettings settings_;
    std::vector<int> patch_of_vertex_, patch_of_triangle_, patch_of_edge_;
    std::vector<Patch> patches_, group_patches_;
    std::vector<int> group_begin_;
    PatchGroups groups_;
};

}  // namespace weft::test
