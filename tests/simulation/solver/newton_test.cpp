// The linear system of a Newton step, its preconditioner, and how it is solved, against double
// precision.

#include "simulation/solver/newton/newton.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernels/newton/control.h"
#include "simulation/families/convert.h"
#include "simulation/scene/read_scene.h"
#include "simulation/solver/newton/conjugate_gradients.h"
#include "tests/kernels/random.h"
#include "tests/kernels/run_on_host.h"
#include "tests/simulation/run/manual_run.h"
#include "tests/simulation/run/test_scenes.h"

namespace weft::test {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The system at the positions that a scene starts with, or that a test puts there.
class System {
public:
    explicit System(const std::string& text)
        : model(parse_scene(text, "test.toml"), warnings),
          substep(model, BodyMomentum::Solves::kAll, 0),
          control("control", WEFT_CONTROL_SIZE),
          cg(model, substep, VertexGraph(model.vertex_count(), model.stencils()), control) {}

    void crumple(float size) {
        Random random(7);
        for (float4& x : model.positions->span()) {
            const float4 d = random.point(size);
            x = {x.x + d.x, x.y + d.y, x.z + d.z, x.w};
        }
    }
    void linearise() {
        const auto where = cg.linearised_at();
        for (Buffer<float4>* buffer : {&where.before, &where.after}) {
            std::ranges::copy(where.positions.span(), buffer->data());
        }
        run(cg.linearise());
        run(cg.coarse().couple(where));
        run(cg.coarse().factor());
        run(cg.coarse().invert());
    }
    /// A p of free vertices; 0 for those that are held.
    std::vector<Vec3> apply(const std::vector<Vec3>& p) {
        write(cg.preconditioned(), p);
        run(cg.product());
        std::vector<Vec3> product(p.size());
        const auto count = p.size();
        for (std::size_t v = 0; v < count; ++v) {
            if (!is_free(v)) continue;
            product[v] = {cg.products()[v], cg.products()[count + v], cg.products()[2 * count + v]};
        }
        return product;
    }
    std::vector<Vec3> precondition(const std::vector<Vec3>& r) {
        write(cg.residuals(), r);
        run({cg.coarse().restrict(cg.residuals())});
        run(cg.correct());
        std::vector<Vec3> u;
        for (const float4& row : cg.preconditioned().span()) u.push_back(to_vec3(row));
        return u;
    }
    /// Of free vertices.
    std::vector<Vec3> random_vector(unsigned seed) const {
        Random random(seed);
        std::vector<Vec3> p;
        for (std::size_t v = 0; v < model.positions->count(); ++v) {
            const Vec3 any = to_vec3(random.point(1.0f));
            p.push_back(is_free(v) ? any : Vec3{});
        }
        return p;
    }
    bool is_free(std::size_t v) const { return (*model.positions)[v].w > 0.0f; }

    static void run(const std::vector<Launch>& launches) {
        for (const Launch& launch : launches) {
            for (int strip = 0; strip < launch.segments.strip_count; ++strip) {
                run_on_host(launch, launch.kernel->form(8), launch.segments.item(strip),
                            launch.segments.item(strip + 1));
            }
        }
    }

    Warnings warnings;
    Model model;
    DescentSubstep substep;
    Buffer<float> control;
    ConjugateGradients cg;

private:
    static void write(Buffer<float4>& rows, const std::vector<Vec3>& values) {
        for (std::size_t v = 0; v < values.size(); ++v) rows[v] = to_float4(values[v]);
    }
};

double product_of(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double sum = 0.0;
    for (std::size_t v = 0; v < a.size(); ++v) sum += dot(a[v], b[v]);
    return sum;
}

double distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double sum = 0.0;
    for (std::size_t v = 0; v < a.size(); ++v) sum += dot(a[v] - b[v], a[v] - b[v]);
    return std::sqrt(sum);
}

/// (M / h^2 + d2E) p with the exact Hessian, in double precision.
std::vector<Vec3> apply_exactly(const System& system, const std::vector<Vec3>& p) {
    const Model& model = system.model;
    std::vector<Vec3> product(p.size());
    for (std::size_t v = 0; v < p.size(); ++v) {
        product[v] = (model.masses[v] / (model.h * model.h)) * p[v];
    }
    for (const auto& family : model.families) {
        for (int e = 0; e < family->count(); ++e) {
            const auto corners = family->corners(e);
            std::array<Vec3, kMaxCorners> x;
            std::array<Mat3, kMaxCorners * kMaxCorners> blocks;
            for (std::size_t k = 0; k < corners.size(); ++k) {
                x[k] = to_vec3((*model.positions)[at(corners[k])]);
            }
            family->hessian(e, x.data(), blocks.data());
            for (std::size_t j = 0; j < corners.size(); ++j) {
                for (std::size_t k = 0; k < corners.size(); ++k) {
                    Vec3& sum = product[at(corners[j])];
                    sum = sum + blocks[j * corners.size() + k] * p[at(corners[k])];
                }
            }
        }
    }
    for (std::size_t v = 0; v < p.size(); ++v) {
        if (!system.is_free(v)) product[v] = {};
    }
    return product;
}

class NewtonSystem : public testing::TestWithParam<const std::string*> {};

/// At rest no element has negative curvature, so nothing is projected away.
TEST_P(NewtonSystem, IsTheExactOneAtRest) {
    System system(*GetParam());
    system.linearise();
    for (const unsigned seed : {1U, 2U, 3U}) {
        const std::vector<Vec3> p = system.random_vector(seed);
        const std::vector<Vec3> exact = apply_exactly(system, p);
        const double size = std::sqrt(product_of(exact, exact));
        EXPECT_LT(distance(system.apply(p), exact), 2e-5 * size);
    }
}

TEST_P(NewtonSystem, IsSymmetricAndPositiveWhateverTheState) {
    for (const float size : {0.0f, 0.01f, 0.1f, 10.0f}) {
        System system(*GetParam());
        system.crumple(size);
        system.linearise();
        for (const unsigned seed : {1U, 2U, 3U, 4U}) {
            const std::vector<Vec3> p = system.random_vector(seed);
            const std::vector<Vec3> q = system.random_vector(seed + 100);
            const std::vector<Vec3> ap = system.apply(p);
            const std::vector<Vec3> aq = system.apply(q);
            const double scale = std::sqrt(product_of(p, ap) * product_of(q, aq));
            EXPECT_GT(product_of(p, ap), 0.0) << "crumpled by " << size;
            EXPECT_NEAR(product_of(p, aq), product_of(q, ap), 1e-5 * scale);
        }
    }
}

TEST_P(NewtonSystem, PreconditionerIsSymmetricAndPositive) {
    for (const float size : {0.0f, 0.1f}) {
        System system(*GetParam());
        system.crumple(size);
        system.linearise();
        for (const unsigned seed : {1U, 2U, 3U, 4U}) {
            const std::vector<Vec3> r = system.random_vector(seed);
            const std::vector<Vec3> s = system.random_vector(seed + 100);
            const std::vector<Vec3> pr = system.precondition(r);
            const std::vector<Vec3> ps = system.precondition(s);
            const double scale = std::sqrt(product_of(r, pr) * product_of(s, ps));
            EXPECT_GT(product_of(r, pr), 0.0);
            EXPECT_NEAR(product_of(r, ps), product_of(s, pr), 1e-4 * scale);
        }
    }
}

/// The coarse matrix is that of the fine one: what a move of whole aggregates asks for, the coarse
/// space answers by that move.
TEST_P(NewtonSystem, CoarseSpaceSolvesForMovesOfAggregates) {
    System system(*GetParam());
    system.crumple(0.01f);
    system.linearise();
    const Aggregates& aggregates = system.cg.coarse().aggregates();
    Random random(3);
    std::vector<Vec3> coarse;
    for (int a = 0; a < aggregates.count(); ++a) coarse.push_back(to_vec3(random.point(1.0f)));
    std::vector<Vec3> fine(system.model.masses.size());
    for (int a = 0; a < aggregates.count(); ++a) {
        for (const int v : aggregates.members[at(a)]) fine[at(v)] = coarse[at(a)];
    }
    system.precondition(system.apply(fine));
    for (int a = 0; a < aggregates.count(); ++a) {
        if (aggregates.members[at(a)].empty()) continue;
        const Vec3 found = to_vec3(system.cg.coarse().corrections()[at(a)]);
        EXPECT_LT(length(found - coarse[at(a)]), 1e-2) << "aggregate " << a;
    }
}

TEST_P(NewtonSystem, IsSolvedByConjugateGradients) {
    System system(*GetParam());
    system.crumple(0.01f);
    system.linearise();
    std::vector<Vec3> force;
    for (const float4& r : system.cg.residuals().span()) force.push_back(to_vec3(r));
    for (int step = 0; step < 300; ++step) {
        System::run(system.cg.correct());
        System::run(system.cg.product());
        System::run(system.cg.advance());
    }
    const std::size_t count = force.size();
    std::vector<Vec3> move(count);
    for (std::size_t v = 0; v < count; ++v) {
        move[v] = {system.cg.moves()[v], system.cg.moves()[count + v],
                   system.cg.moves()[2 * count + v]};
    }
    EXPECT_LT(distance(system.apply(move), force), 1e-3 * std::sqrt(product_of(force, force)));
    // And the model of E has fallen by what the steps say.
    EXPECT_NEAR(system.cg.scalars()[0].z, product_of(force, move), 1e-3 * product_of(force, move));
}

INSTANTIATE_TEST_SUITE_P(Scenes, NewtonSystem,
                         testing::Values(&kEverything, &kSolids, &kSewn, &kWoven),
                         [](const auto& given) {
                             const std::string* scene = given.param;
                             return scene == &kEverything ? "Cloth"
                                    : scene == &kSolids   ? "Solids"
                                    : scene == &kSewn     ? "Sewn"
                                                          : "Woven";
                         });

TEST(NewtonAggregates, AreFreeVerticesOfOneStripEach) {
    System system(kEverything);
    const Aggregates& aggregates = system.cg.coarse().aggregates();
    std::size_t members = 0;
    for (int a = 0; a < aggregates.count(); ++a) {
        for (const int v : aggregates.members[at(a)]) {
            EXPECT_EQ(system.model.strips.strip_of(v), a / aggregates.per_strip);
            EXPECT_TRUE(system.is_free(at(v)));
            EXPECT_EQ(aggregates.of[at(v)], a);
            ++members;
        }
    }
    EXPECT_GT(members, system.model.masses.size() / 2);
}

/// Neither masses nor stiffness count alone; powers of two change no rounding.
TEST(NewtonSolver, ScalingMassAndStiffnessChangesNothing) {
    Scene scene = parse_scene(kSpringsOnly, "test.toml");
    scene.solver.method = Method::kNewton;
    ManualRun run(scene);
    run.run(2);
    for (const double factor : {0x1p-20, 0x1p20}) {
        Scene scaled = scene;
        scaled.cloths[0].density *= factor;
        scaled.cloths[0].stretch.stiffness *= factor;
        ManualRun other(scaled);
        other.run(2);
        EXPECT_EQ(other.hash(), run.hash()) << "times " << factor;
    }
}

}  // namespace
}  // namespace weft::test
