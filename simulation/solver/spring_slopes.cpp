#include "kernels/descent/gather_forces.h"
#include "kernels/descent/gather_springs.h"
#include "simulation/solver/sliced_rows.h"
#include "simulation/solver/slopes.h"

namespace weft {

namespace {

/// The springs at each vertex.
struct Ends {
    std::vector<std::vector<int>> springs;  ///< [vertices]
    std::vector<int> lengths;               ///< [items] how many

    Ends(const Springs& all, const VertexItems& items)
        : springs(static_cast<std::size_t>(items.count())) {
        for (int s = 0; s < all.elements.count(); ++s) {
            for (const int v : all.elements.vertices_of(s)) {
                springs[static_cast<std::size_t>(v)].push_back(s);
            }
        }
        for (int i = 0; i < items.count(); ++i) {
            lengths.push_back(static_cast<int>(at(items.vertex(i)).size()));
        }
    }
    const std::vector<int>& at(int vertex) const {
        return springs[static_cast<std::size_t>(vertex)];
    }
};

class SpringSlopes final : public SlopeFamily {
public:
    SpringSlopes(const Springs& springs, const VertexItems& items)
        : SpringSlopes(springs, items, Ends(springs, items)) {}

    Launch gather(const SlopeTarget& t) override {
        return launch(kernels::gather_springs, t.segments, t.positions, t.vertices, rows_.slices(),
                      others_, material_, t.sums, t.item_count, rows_.entry_count(),
                      SlicedRows::kStride, t.fresh);
    }

    Launch gather_forces(const SlopeTarget& t) override {
        return launch(kernels::gather_spring_forces, t.segments, t.positions, t.vertices,
                      rows_.slices(), others_, material_, t.sums, t.item_count, rows_.entry_count(),
                      SlicedRows::kStride, t.fresh);
    }

private:
    SpringSlopes(const Springs& springs, const VertexItems& items, const Ends& ends)
        : rows_("springs.rows", items.segment_begin(), ends.lengths),
          others_("springs.others", static_cast<std::size_t>(rows_.entry_count())),
          material_("springs.row_material", 2 * others_.count()) {
        for (int i = 0; i < items.count(); ++i) {
            const int vertex = items.vertex(i);
            const std::vector<int>& row = ends.at(vertex);
            for (int k = 0; k < rows_.length(i); ++k) {
                const std::size_t entry = rows_.entry(i, k);
                const auto place = static_cast<std::size_t>(k);
                if (place < row.size()) {
                    add(springs, row[place], vertex, entry);
                } else {
                    others_[entry] = vertex;  // without stiffness
                }
            }
        }
    }

    void add(const Springs& springs, int spring, int vertex, std::size_t entry) {
        const auto ends = springs.elements.vertices_of(spring);
        others_[entry] = ends[0] == vertex ? ends[1] : ends[0];
        material_[entry] = static_cast<float>(springs.rest_length(spring));
        material_[others_.count() + entry] = static_cast<float>(springs.stiffness(spring));
    }

    SlicedRows rows_;
    Buffer<int> others_;
    Buffer<float> material_;
};

}  // namespace

std::unique_ptr<SlopeFamily> make_spring_slopes(const Springs& springs, const VertexItems& items) {
    return std::make_unique<SpringSlopes>(springs, items);
}

}  // namespace weft
