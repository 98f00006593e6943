#include "simulation/model/substeps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "simulation/model/unfinished.h"

namespace weft {

namespace {

Vec3 strongest_gravity(const Scene& scene) {
    Vec3 strongest = scene.gravity_keys.empty() ? scene.gravity : Vec3{};
    for (const GravityKey& key : scene.gravity_keys) {
        if (length(key.gravity) > length(strongest)) strongest = key.gravity;
    }
    return strongest;
}

/// Iterations by how far they carry a correction: a step of conjugate gradients as far as a sweep.
int carrying_iterations(const SolverSettings& solver) {
    if (solver.method != Method::kNewton) return solver.iterations;
    return solver.iterations * (solver.cg_steps + solver.sweeps);
}

/// What few iterations take back of a sag, in parts of what as many of descent do, as measured:
/// Chebyshev's method makes up for jpgd's shorter steps from the fourth on.
double share_of_bending(const SolverSettings& solver) {
    if (solver.method == Method::kJpgd) return std::min(1.0, solver.iterations / 4.0);
    return solver.method == Method::kXpbd && solver.iterations == 1 ? 2.0 / 3.0 : 1.0;
}

/// What the scene's solver has to carry.
///
/// Only xpbd feels what else hangs on a body: its constraints share by masses. Descent moves the
/// heavy ones by their own equations, and light ones follow: seams of 1e4 times the mass left as
/// little strain as those of equal ones, where it was tried. Newton's conjugate gradients reach as
/// far as what bends needs.
std::vector<LoadPath> paths_of(const Scene& scene, const Gathered& all) {
    std::vector<Stencils> links;
    for (const auto& family : all.families) {
        if (family->stencils().arity == 2) links.push_back(family->stencils());
    }
    const Method method = scene.solver.method;
    const Vec3 bending = method == Method::kNewton ? Vec3{} : strongest_gravity(scene);
    std::vector<LoadPath> paths = load_paths(all, links, bending);
    for (LoadPath& path : paths) {
        path.firmness /= share_of_bending(scene.solver);
        if (method == Method::kXpbd) continue;
        path.burden = 1.0;
        path.span = 0.0;
    }
    return paths;
}

/// The largest coordinate of anything with mass [m].
double reach_of_masses(const Gathered& all) {
    double most = 0.0;
    for (std::size_t v = 0; v < all.rest.size(); ++v) {
        if (!(all.masses[v] > 0.0)) continue;
        const Vec3& x = all.rest[v];
        most = std::max({most, std::abs(x.x), std::abs(x.y), std::abs(x.z)});
    }
    return most;
}

constexpr double kLongestStep = 1.0 / 240.0;  // [s]
/// newton's iterations need no shorter ones, but sheets that land on each other were in each other
/// for a frame (docs/measurements.md, "Sheets that land by newton").
constexpr double kLongestStepOfSheets = 1.0 / 480.0;

double longest_step(const Scene& scene) {
    const bool may_land = scene.contact && !scene.cloths.empty();
    const bool is_newton = scene.solver.method == Method::kNewton;
    return may_land && is_newton ? kLongestStepOfSheets : kLongestStep;
}

double rounded(double substeps) {
    constexpr double kRounding = 1e-6;  // 0.016666667 is a sixtieth of a second
    return std::max(1.0, std::ceil(substeps - kRounding));
}

/// What a scene's paths need.
class Substeps {
public:
    Substeps(const Scene& scene, const Gathered& all)
        : scene_(scene),
          paths_(paths_of(scene, all)),
          iterations_(carrying_iterations(scene.solver)),
          gravity_(length(strongest_gravity(scene))),
          reach_(reach_of_masses(all)) {}

    int chosen() const {
        // Corrections so fine that single precision loses them carry no weight any farther.
        const double strain = std::min(std::max(for_strain(), for_spans()), of_rounding());
        const double all = std::max({scene_.dt / longest_step(scene_), strain, for_bending()});
        return static_cast<int>(std::min(rounded(all), kMostSubsteps));
    }

    void warn_of_strain(int substeps, Warnings& warnings) const {
        constexpr double kUnbelievable = 0.1;
        for (const LoadPath& path : paths_) {
            const double strain =
                unfinished_strain(path, scene_.dt / substeps, iterations_, gravity_);
            if (strain < kUnbelievable || !bears(path)) continue;
            warnings.push_back(fmt::format(
                "'{}' is too fine for scene.substeps = {} of {} iterations: they will leave it "
                "stretched by some {:.0f} %, whatever its stiffness; {:.0f} substeps would make "
                "that "
                "half a per cent",
                path.body, substeps, iterations_, 100.0 * strain, rounded(for_strain())));
            return;
        }
    }

    void warn_of_spans(int substeps, Warnings& warnings) const {
        constexpr double kMore = 1.25;
        const auto [worst, wanted] =
            worst_of(kMore * substeps, [&](const LoadPath& path) { return for_span(path); });
        if (worst == nullptr) return;
        const double kept = finished_stiffness(*worst, scene_.dt / substeps, iterations_);
        const double sag =
            sag_of_span(*worst, counted_gravity(), kept) / sag_of_span(*worst, counted_gravity());
        warnings.push_back(fmt::format(
            "'{}' is stretched between where it is held, and is so stiff and fine that {} substeps "
            "of {} iterations of xpbd let it sag {:.2g} times as far as it should; scene.substeps "
            "= {:.0f} would do, or longer edges, or another solver",
            worst->body, substeps, iterations_, sag, rounded(wanted)));
    }

    void warn_of_sag(int substeps, Warnings& warnings) const {
        constexpr double kFarMore = 1.5;
        const auto [worst, wanted] =
            worst_of(kFarMore * substeps, [&](const LoadPath& path) { return for_bending(path); });
        if (worst == nullptr) return;
        const double sag = 1.0 + unfinished_sag(*worst, scene_.dt / substeps, iterations_);
        warnings.push_back(fmt::format(
            "'{}' bears its weight by bending, and is so stiff and fine that {} substeps of {} "
            "iterations may let it sag {:.2g} times as far as it should; scene.substeps = {:.0f} "
            "would do, or longer edges, or solver.method = \"newton\"",
            worst->body, substeps, iterations_, sag, rounded(wanted)));
    }

private:
    /// The one that needs the most of all, and how many; null: none needs more than that.
    template <class Needed>
    std::pair<const LoadPath*, double> worst_of(double most, const Needed& needed) const {
        const LoadPath* worst = nullptr;
        for (const LoadPath& path : paths_) {
            if (needed(path) <= most) continue;
            worst = &path;
            most = needed(path);
        }
        return {worst, most};
    }

    /// Whether its weight is ever carried: what falls for ever is not stretched by it.
    bool bears(const LoadPath& path) const {
        return path.is_held || !scene_.obstacles.empty() || scene_.contact;
    }

    /// Something moves in every scene, if by pins alone: as if by this much gravity at least.
    double counted_gravity() const {
        constexpr double kLeast = 1.0;  // [m/s^2]
        return std::max(kLeast, gravity_);
    }

    double for_strain() const {
        double substeps = 1.0;
        for (const LoadPath& path : paths_) {
            substeps = std::max(
                substeps, substeps_for_strain(path, scene_.dt, iterations_, counted_gravity()));
        }
        return substeps;
    }

    double for_span(const LoadPath& path) const {
        return substeps_for_span(path, scene_.dt, iterations_, counted_gravity());
    }

    double for_spans() const {
        double substeps = 1.0;
        for (const LoadPath& path : paths_) substeps = std::max(substeps, for_span(path));
        return substeps;
    }

    double for_bending(const LoadPath& path) const {
        return substeps_for_bending(path, scene_.dt, iterations_, counted_gravity());
    }

    double for_bending() const {
        double substeps = 1.0;
        for (const LoadPath& path : paths_) substeps = std::max(substeps, for_bending(path));
        return substeps;
    }

    /// As the start of a run judges them.
    double of_rounding() const {
        return substeps_of_rounding(reach_, scene_.dt, length(scene_.gravity_at(0.0)));
    }

    const Scene& scene_;
    std::vector<LoadPath> paths_;
    int iterations_;
    double gravity_, reach_;
};

}  // namespace

Scene with_substeps(Scene scene, const Gathered& all, Warnings& warnings) {
    const Substeps substeps(scene, all);
    const int count = scene.substeps > 0 ? scene.substeps : substeps.chosen();
    substeps.warn_of_strain(count, warnings);
    substeps.warn_of_spans(count, warnings);
    substeps.warn_of_sag(count, warnings);
    scene.substeps = count;
    return scene;
}

Scene with_substeps(const Scene& scene) {
    if (scene.substeps > 0) return scene;
    Warnings unheard;
    return with_substeps(scene, gather(scene, unheard), unheard);
}

}  // namespace weft
