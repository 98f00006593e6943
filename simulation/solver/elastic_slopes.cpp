#include "kernels/descent/gather_membranes.h"
#include "kernels/descent/gather_tetrahedra.h"
#include "simulation/solver/sliced_rows.h"
#include "simulation/solver/slopes.h"

namespace weft {

namespace {

/// A corner of an element, seen from the vertex that it is at.
struct Corner {
    int element;
    int corner;
};

/// Which corners of elements are at each vertex.
struct Corners {
    std::vector<std::vector<Corner>> at;  ///< [vertices]
    std::vector<int> lengths;             ///< [items] how many

    Corners(const Elements& elements, const VertexItems& items)
        : at(static_cast<std::size_t>(items.count())) {
        for (int e = 0; e < elements.count(); ++e) {
            const auto vertices = elements.vertices_of(e);
            for (int k = 0; k < elements.arity(); ++k) {
                at[static_cast<std::size_t>(vertices[static_cast<std::size_t>(k)])].push_back(
                    {e, k});
            }
        }
        for (int i = 0; i < items.count(); ++i) {
            lengths.push_back(
                static_cast<int>(at[static_cast<std::size_t>(items.vertex(i))].size()));
        }
    }
};

std::array<double, 3> numbers_of(Vec3 b) { return {b.x, b.y, b.z}; }
std::array<double, 2> numbers_of(std::array<double, 2> b) { return b; }

/// Tetrahedra or membranes. Rows hold the elements' other corners, in the order that follows the
/// vertex' own; entries without an element name the vertex itself and have no stiffness.
template <class Kind, class Kernel, class ForcesKernel>
class ElasticSlopes final : public SlopeFamily {
public:
    ElasticSlopes(const std::string& name, const Kind& kind, const VertexItems& items)
        : ElasticSlopes(name, kind, items, Corners(kind.elements, items)) {}

    Launch gather(const SlopeTarget& t) override { return launch_over_rows(Kernel{}, t); }
    Launch gather_forces(const SlopeTarget& t) override {
        return launch_over_rows(ForcesKernel{}, t);
    }

private:
    ElasticSlopes(const std::string& name, const Kind& kind, const VertexItems& items,
                  const Corners& corners)
        : rows_(name + ".rows", items.segment_begin(), corners.lengths),
          others_(name + ".others", entries() * others_per_entry(kind)),
          shape_(name + ".row_shape",
                 others_.count() * numbers_of(kind.shape_gradient(0, 0)).size()),
          material_(name + ".row_material", entries() * 2) {
        for (int i = 0; i < items.count(); ++i) {
            const int vertex = items.vertex(i);
            const auto& row = corners.at[static_cast<std::size_t>(vertex)];
            for (int k = 0; k < rows_.length(i); ++k) {
                const std::size_t entry = rows_.entry(i, k);
                const auto place = static_cast<std::size_t>(k);
                for (std::size_t o = 0; o < others_per_entry(kind); ++o) {
                    others_[o * entries() + entry] = vertex;
                }
                if (place < row.size()) add(kind, row[place], entry);
            }
        }
    }

    template <class AnyKernel>
    Launch launch_over_rows(AnyKernel kernel, const SlopeTarget& t) {
        return launch(kernel, t.segments, t.positions, t.vertices, rows_.slices(), others_, shape_,
                      material_, t.sums, t.item_count, rows_.entry_count(), SlicedRows::kStride,
                      t.fresh);
    }

    std::size_t entries() const { return static_cast<std::size_t>(rows_.entry_count()); }
    static std::size_t others_per_entry(const Kind& kind) {
        return static_cast<std::size_t>(kind.elements.arity() - 1);
    }

    void add(const Kind& kind, Corner at, std::size_t entry) {
        const auto vertices = kind.elements.vertices_of(at.element);
        std::size_t column = 0;
        for (std::size_t o = 0; o < others_per_entry(kind); ++o) {
            const int corner = (at.corner + 1 + static_cast<int>(o)) % kind.elements.arity();
            others_[o * entries() + entry] = vertices[static_cast<std::size_t>(corner)];
            for (const double number : numbers_of(kind.shape_gradient(at.element, corner))) {
                shape_[column++ * entries() + entry] = static_cast<float>(number);
            }
        }
        material_[entry] = static_cast<float>(kind.mu(at.element));
        material_[entries() + entry] = static_cast<float>(kind.lambda(at.element));
    }

    SlicedRows rows_;
    Buffer<int> others_;
    Buffer<float> shape_;
    Buffer<float> material_;
};

}  // namespace

std::unique_ptr<SlopeFamily> make_membrane_slopes(const Membranes& membranes,
                                                  const VertexItems& items) {
    using Family = ElasticSlopes<Membranes, kernels::gather_membranes_kernel,
                                 kernels::gather_membrane_forces_kernel>;
    return std::make_unique<Family>("membranes", membranes, items);
}

std::unique_ptr<SlopeFamily> make_tetrahedron_slopes(const Tetrahedra& tetrahedra,
                                                     const VertexItems& items) {
    using Family = ElasticSlopes<Tetrahedra, kernels::gather_tetrahedra_kernel,
                                 kernels::gather_tetrahedra_forces_kernel>;
    return std::make_unique<Family>("tetrahedra", tetrahedra, items);
}

}  // namespace weft
