#include "simulation/reference/newton.h"

#include <algorithm>
#include <cmath>

#include "simulation/reference/linear_solver.h"

namespace weft {

namespace {

constexpr int kMaxIterations = 1000;
constexpr double kDecrease = 1e-4;  // Armijo's constant
/// A predicted decrease of E below this part of E is lost in its rounding; the gradient, which is
/// not, then judges a step.
constexpr double kEnergyDigits = 1e-11;
/// Nothing is left to gain, by the gradient or by the gap's part of the first one. (The gap goes
/// with the gradient's square.)
constexpr double kLastGradient = 1e-15;
constexpr double kLastGap = 1e-21;

double norm(std::span<const Vec3> a) {
    double sum = 0.0;
    for (const Vec3& v : a) sum += dot(v, v);
    return std::sqrt(sum);
}

double product(std::span<const Vec3> a, std::span<const Vec3> b) {
    double sum = 0.0;
    for (std::size_t v = 0; v < a.size(); ++v) sum += dot(a[v], b[v]);
    return sum;
}

/// One descent, with its state.
class Newton {
public:
    Newton(IncrementalPotential& potential, std::vector<Vec3> start)
        : potential_(potential),
          x_(std::move(start)),
          direction_(x_.size()),
          energy_(potential.energy(x_)),
          gradient_(potential.gradient(x_)) {
        find_direction();
        first_gap_ = gap();
    }

    /// How much the quadratic model of E promises to gain.
    double gap() const { return std::abs(0.5 * product(gradient_, direction_)); }
    double relative_gradient() const {
        const double forces = potential_.force_size(x_);
        return forces > 0.0 ? norm(gradient_) / forces : 0.0;
    }

    bool is_done() const {
        return relative_gradient() <= kLastGradient || gap() <= kLastGap * first_gap_;
    }

    /// False where nothing can be improved.
    bool step() {
        const double slope = product(gradient_, direction_);
        if (!(slope < 0.0)) return false;
        for (double length = 1.0; length > 1e-10; length *= 0.5) {
            if (!try_step(length, slope)) continue;
            find_direction();
            return true;
        }
        return false;
    }

    const std::vector<Vec3>& x() const { return x_; }
    double energy() const { return energy_; }

private:
    /// The less gradient is left, the more precisely its step is computed: convergence stays
    /// superlinear (Eisenstat and Walker 1996).
    double tolerance() const {
        if (first_gap_ == 0.0) return 0.1;
        return std::clamp(std::sqrt(std::sqrt(gap() / first_gap_)), 1e-7, 0.1);
    }

    void find_direction() {
        std::vector<Vec3> force(gradient_.size());
        for (std::size_t v = 0; v < force.size(); ++v) force[v] = -gradient_[v];
        // As little projection as will do: the less, the faster it converges. Next time, a quarter.
        constexpr double kLeast = 0.02;
        double projection = projection_ > kLeast ? projection_ / 4.0 : 0.0;
        for (;;) {
            const BlockMatrix& hessian = potential_.hessian(x_, projection);
            const auto result = linear_.solve(hessian, force, tolerance(), direction_);
            projection_ = projection;
            if (result != LinearSolver::Result::kIndefinite) return;
            if (projection == 1.0) break;
            projection = std::clamp(4.0 * projection, kLeast, 1.0);
        }
        // Rounding made even the projected one indefinite: go down by inertia alone.
        for (std::size_t v = 0; v < force.size(); ++v) {
            const double inertia = potential_.inertia()[v];
            direction_[v] = inertia > 0.0 ? (1.0 / inertia) * force[v] : Vec3{};
        }
    }

    bool try_step(double length, double slope) {
        std::vector<Vec3> x = x_;
        for (std::size_t v = 0; v < x.size(); ++v) x[v] = x[v] + length * direction_[v];
        const double energy = potential_.energy(x);
        if (!std::isfinite(energy)) return false;
        const bool is_lost_in_rounding = -length * slope < kEnergyDigits * std::abs(energy_);
        if (!is_lost_in_rounding && energy > energy_ + kDecrease * length * slope) return false;
        std::vector<Vec3> gradient = potential_.gradient(x);
        if (is_lost_in_rounding && !(norm(gradient) < 0.9 * norm(gradient_))) return false;
        x_ = std::move(x);
        energy_ = energy;
        gradient_ = std::move(gradient);
        return true;
    }

    IncrementalPotential& potential_;
    LinearSolver linear_;
    std::vector<Vec3> x_, direction_;
    double energy_;
    std::vector<Vec3> gradient_;
    double first_gap_ = 0.0;
    double projection_ = 0.0;
};

}  // namespace

Minimum minimise(IncrementalPotential& potential, std::vector<Vec3> start,
                 const std::function<void(const Certificate&)>& progress, double enough) {
    Minimum minimum;
    minimum.start_energy = potential.energy(potential.predicted());
    Newton newton(potential, std::move(start));
    Certificate& certificate = minimum.certificate;
    for (;;) {
        certificate.relative_gradient = newton.relative_gradient();
        certificate.relative_gap =
            newton.gap() / std::max(minimum.start_energy - newton.energy(), newton.gap());
        if (progress) progress(certificate);
        if (newton.is_done() || certificate.relative_gap <= enough) break;
        if (certificate.iterations == kMaxIterations || !newton.step()) break;
        ++certificate.iterations;
    }
    minimum.x = newton.x();
    minimum.energy = newton.energy();
    return minimum;
}

}  // namespace weft
