#include "simulation/reference/minimum_cache.h"

#include <cstring>
#include <filesystem>

#include "runtime/io/cache_folder.h"
#include "simulation/reference/equilibrium.h"

namespace weft {

namespace {

namespace fs = std::filesystem;

/// To be raised when the meaning of the file or of an energy changes.
constexpr double kVersion = 3;

/// The last digits of E - E*: errors are told to 1e-8 or so. (Those of x would take as long again.)
constexpr double kEnoughGap = 1e-15;

template <class T>
void append(std::string& bytes, const std::vector<T>& values) {
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

/// Everything that E(x) depends on. The material is taken by its effect: the energy and the
/// gradient at two places, to the last bit.
std::string problem_bytes(const IncrementalPotential& potential) {
    std::string bytes;
    append(bytes, std::vector<double>{kVersion});
    append(bytes, potential.predicted());
    append(bytes, potential.inertia());
    for (const auto& family : potential.families()) {
        for (int e = 0; e < family->count(); ++e) {
            const auto corners = family->corners(e);
            append(bytes, std::vector<int>(corners.begin(), corners.end()));
        }
    }
    for (const FrozenContact& c : potential.contacts()) {
        append(bytes, std::vector<int>(c.corners.begin(), c.corners.end()));
        append(bytes, std::vector<double>(c.weights.begin(), c.weights.end()));
        append(bytes, std::vector<double>{c.normal.x, c.normal.y, c.normal.z, c.range, c.stiffness,
                                          c.rubbing.friction, c.rubbing.creep, c.earlier_slip.x,
                                          c.earlier_slip.y, c.earlier_slip.z});
    }
    std::vector<Vec3> x = potential.predicted();
    for (int place = 0; place < 2; ++place) {
        append(bytes, std::vector<double>{potential.energy(x)});
        append(bytes, potential.gradient(x));
        for (Vec3& v : x) v = {1.25 * v.x + 0.125 * v.y, v.y - 0.25 * v.z, 1.5 * v.z + 0.125 * v.x};
    }
    return bytes;
}

fs::path cached_file(const IncrementalPotential& potential) {
    const fs::path folder = cache_folder();
    if (folder.empty()) return {};
    return folder / ("minimum-" + cache_key(problem_bytes(potential)) + ".bin");
}

/// The file: energy, start energy, certificate (3 numbers), then xyz of every vertex; doubles.
constexpr std::size_t kHeader = 5;

std::string to_bytes(const Minimum& minimum) {
    const Certificate& c = minimum.certificate;
    std::string bytes;
    append(bytes, std::vector<double>{minimum.energy, minimum.start_energy, c.relative_gradient,
                                      c.relative_gap, static_cast<double>(c.iterations)});
    for (const Vec3& x : minimum.x) append(bytes, std::vector<double>{x.x, x.y, x.z});
    return bytes;
}

bool read_minimum(const fs::path& path, IncrementalPotential& potential, Minimum& minimum) {
    const std::string bytes = read_cached(path);
    const std::size_t vertices = potential.predicted().size();
    std::vector<double> numbers(kHeader + 3 * vertices);
    if (bytes.size() != numbers.size() * sizeof(double)) return false;
    std::memcpy(numbers.data(), bytes.data(), bytes.size());
    minimum.energy = numbers[0];
    minimum.start_energy = numbers[1];
    minimum.certificate = {numbers[2], numbers[3], static_cast<int>(numbers[4])};
    minimum.x.clear();
    for (std::size_t v = 0; v < vertices; ++v) {
        const double* x = &numbers[kHeader + 3 * v];
        minimum.x.push_back({x[0], x[1], x[2]});
    }
    potential.press_as_at(minimum.x);
    return potential.energy(minimum.x) == minimum.energy &&
           potential.energy(potential.predicted()) == minimum.start_energy;
}

std::vector<Vec3> start_of(const IncrementalPotential& potential,
                           const std::function<std::vector<Vec3>()>& guess) {
    std::vector<Vec3> start = guess ? guess() : std::vector<Vec3>{};
    const bool is_better = start.size() == potential.predicted().size() &&
                           potential.energy(start) < potential.energy(potential.predicted());
    return is_better ? start : potential.predicted();
}

}  // namespace

Minimum find_minimum(IncrementalPotential& potential,
                     const std::function<std::vector<Vec3>()>& guess,
                     const std::function<void(const Certificate&)>& progress) {
    const fs::path path = cached_file(potential);
    Minimum minimum;
    if (!path.empty() && read_minimum(path, potential, minimum)) return minimum;
    minimum = find_equilibrium(potential, start_of(potential, guess), progress, kEnoughGap);
    if (!path.empty() && minimum.certificate.relative_gap <= kSolvedGap) {
        write_cached(path, to_bytes(minimum));
    }
    return minimum;
}

}  // namespace weft
