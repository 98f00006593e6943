// What detection costs per vertex and substep on one core: boxes, near patches, pairs. A sheet
// where nothing is near, and stacks.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "simulation/contact/pairs.h"
#include "simulation/families/convert.h"

namespace weft {
namespace {

/// Edges at rest are 1 long; lengths below are in edges.
struct StackShape {
    int layers, size;
    double gap, reach;
    float thickness = 0.25f;
    float stride = 0.0f;  ///< of the layers between each other, per substep
};

struct Stack {
    SurfaceMesh mesh;
    Strips strips;
    std::vector<float4> anchors;

    explicit Stack(const StackShape& shape) {
        std::mt19937 engine(1);
        const auto shake = [&] {
            return 0.02 * (static_cast<double>(engine() % 1000) / 500.0 - 1.0);
        };
        const int per_layer = shape.size * shape.size;
        Stencils triangles{3, {}};
        std::vector<float4> unordered;
        for (int v = 0; v < shape.layers * per_layer; ++v) {
            const int layer = v / per_layer;
            const int row = v % per_layer / shape.size;
            const double turn = 0.1 * layer;
            const double x = v % shape.size - 0.5 * shape.size;
            const double z = row - 0.5 * shape.size;
            const Vec3 at{x * std::cos(turn) - z * std::sin(turn), shape.gap * layer + shake(),
                          x * std::sin(turn) + z * std::cos(turn)};
            mesh.rest.push_back({x, 2.0 * layer, z});
            mesh.held.push_back(0);
            mesh.knots.push_back(static_cast<int>(mesh.knots.size()));
            unordered.push_back(to_float4(at, shape.reach));
            if (row + 1 == shape.size || v % shape.size + 1 == shape.size) continue;
            mesh.triangles.push_back({v, v + shape.size, v + 1});
            mesh.triangles.push_back({v + 1, v + shape.size, v + shape.size + 1});
            mesh.triangle_body.insert(mesh.triangle_body.end(), 2, layer);
        }
        for (const auto& t : mesh.triangles) {
            triangles.vertices.insert(triangles.vertices.end(), t.begin(), t.end());
        }
        strips = make_strips(static_cast<int>(unordered.size()), std::vector{triangles});
        for (auto& t : mesh.triangles) {
            for (int& v : t) v = strips.rank[static_cast<std::size_t>(v)];
        }
        const std::vector<Vec3> rest = mesh.rest;
        for (std::size_t v = 0; v < rest.size(); ++v) {
            mesh.rest[v] = rest[static_cast<std::size_t>(strips.order[v])];
            anchors.push_back(unordered[static_cast<std::size_t>(strips.order[v])]);
        }
    }
};

/// A launch with what its kernel takes, called on this thread: the machine may be busy.
class Call {
public:
    explicit Call(const Launch& launch) : launch_(launch), values_(launch.arguments.size()) {}

    void operator()(int strip_count) {
        addresses_.clear();
        for (std::size_t i = 0; i < values_.size(); ++i) {
            const Argument& argument = launch_.arguments[i];
            if (argument.buffer != nullptr)
                values_[i].pointer = argument.buffer->host();
            else if (launch_.kernel->parameters[i] == kernels::Parameter::kFloat)
                values_[i].real = argument.real;
            else
                values_[i].integer = argument.integer;
            addresses_.push_back(&values_[i]);
        }
        for (int s = 0; s < strip_count; ++s) {
            const int begin = launch_.segments.item(s);
            const int end = launch_.segments.item(s + 1);
            if (begin < end) form_(begin, end, addresses_.data());
        }
    }

private:
    union Value {
        float real;
        int integer;
        void* pointer;
    };
    const Launch& launch_;
    kernels::RangeFunction form_ = launch_.kernel->form(kernels::widest_pack());
    std::vector<Value> values_;
    std::vector<const void*> addresses_;
};

class Detection {
public:
    explicit Detection(const StackShape& shape)
        : stack_(shape),
          anchors_("anchors", stack_.anchors.size()),
          strides_("strides", stack_.anchors.size()),
          strip_begin_("strips", stack_.strips.begin.size()),
          strips_{&strip_begin_, 0, 1, stack_.strips.count()} {
        std::ranges::copy(stack_.anchors, anchors_.data());
        for (std::size_t v = 0; v < strides_.count(); ++v) {
            const bool is_odd =
                static_cast<int>(std::lround(static_cast<double>(anchors_[v].y) / shape.gap)) % 2 !=
                0;
            strides_[v].x = is_odd ? shape.stride : 0.0f;
        }
        std::ranges::copy(stack_.strips.begin, strip_begin_.data());
        pairs_ = std::make_unique<ContactPairs>(
            make_surface(stack_.mesh, stack_.strips), stack_.mesh.rest, anchors_, anchors_,
            strides_, strips_, PairSettings{shape.thickness, 0.1f * shape.thickness, true, 4}, 0);
        bool grew = true;
        while (grew) {
            run_all();
            grew = false;
            for (RowTable* table : pairs_->tables()) {
                if (!table->overflowed()) continue;
                table->grow();
                grew = true;
            }
        }
        run_all();
    }

    void run_all() {
        for (std::size_t kind = 0; kind < 3; ++kind) run(kind);
    }
    /// One of boxes, near, pairs.
    void run(std::size_t kind) {
        for (const Launch& launch : pairs_->bodies()[kind]->launches) {
            Call call(launch);
            call(strips_.strip_count);
        }
    }
    int vertex_count() const { return static_cast<int>(anchors_.count()); }
    double entries(ContactPairs::Table& t) const {
        double sum = 0.0;
        for (const int count : t.table.counts().span()) sum += count;
        return sum / vertex_count();
    }
    ContactPairs& pairs() { return *pairs_; }

private:
    Stack stack_;
    Buffer<float4> anchors_, strides_;
    Buffer<int> strip_begin_;
    Segments strips_;
    std::unique_ptr<ContactPairs> pairs_;
};

void count(benchmark::State& state, Detection& run) {
    state.counters["per_vertex"] =
        benchmark::Counter(run.vertex_count(), benchmark::Counter::kIsIterationInvariantRate |
                                                   benchmark::Counter::kInvert);
    state.counters["vt"] = run.entries(run.pairs().vt());
    state.counters["ee"] = run.entries(run.pairs().ee());
    state.counters["near"] = run.entries(run.pairs().near());
}

/// Where nothing has moved.
void detect(benchmark::State& state, std::size_t kind, const StackShape& shape) {
    Detection run(shape);
    for (auto _ : state) run.run(kind);
    count(state, run);
}

/// Where candidates have to be collected anew as far as layers move.
void all(benchmark::State& state, const StackShape& shape) {
    Detection run(shape);
    for (auto _ : state) run.run_all();
    count(state, run);
}

void boxes(benchmark::State& state, const StackShape& shape) { detect(state, 0, shape); }
void near(benchmark::State& state, const StackShape& shape) { detect(state, 1, shape); }
void pairs(benchmark::State& state, const StackShape& shape) { detect(state, 2, shape); }

// A reach of less than 0.28 edges is one with which a sheet cannot fold.
constexpr StackShape kSheet{1, 200, 1.0, 0.1};
constexpr StackShape kFastSheet{1, 100, 1.0, 0.5};
constexpr StackShape kStack{50, 40, 0.2, 0.1};
// Layers that move by so many thicknesses per substep.
constexpr StackShape kSlowStack{50, 40, 0.2, 0.1, 0.25f, 0.02f * 0.25f};
constexpr StackShape kSlidingStack{50, 40, 0.2, 0.1, 0.25f, 0.1f * 0.25f};
constexpr StackShape kFastStack{50, 40, 0.2, 0.1, 0.25f, 0.5f * 0.25f};

BENCHMARK_CAPTURE(boxes, sheet, kSheet)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(near, sheet, kSheet)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(pairs, sheet, kSheet)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(pairs, fast_sheet, kFastSheet)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(boxes, stack_of_50, kStack)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(near, stack_of_50, kStack)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(pairs, stack_of_50, kStack)->Unit(benchmark::kMillisecond);

BENCHMARK_CAPTURE(all, stack_of_50, kStack)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(all, slow_stack_of_50, kSlowStack)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(all, sliding_stack_of_50, kSlidingStack)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(all, fast_stack_of_50, kFastStack)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace weft
