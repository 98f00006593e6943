#include "simulation/families/builder.h"
#include "simulation/families/springs/attachments.h"
#include "simulation/families/springs/springs.h"

namespace weft {

namespace {

/// Edges of cloths, then attachments.
class SpringsBuilder final : public FamilyBuilder {
public:
    SpringsBuilder() : FamilyBuilder({"springs", "springs", "stretch"}, 2) {}

    void add(const ClothPart& part) override {
        if (part.cloth.stretch.stiffness <= 0.0) return;
        append(part.adjacency.edges, part.first_vertex);
        fill(compliances_, static_cast<float>(1.0 / part.cloth.stretch.stiffness));
        lengths_.reserve(compliances_.size());
        for (int e = 0; e < part.adjacency.edges.count(); ++e) {
            const auto ends = part.adjacency.edges[e];
            lengths_.push_back(static_cast<float>(part.rest.length_of(ends[0], ends[1])));
        }
        edge_count_ = stencils().count();
    }

    void add(const ScenePart& part) override {
        for (const Attachment& attachment : part.scene.attachments) {
            const auto ties = find_ties(attachment, part.scene, part.bodies, part.rest);
            append(ties, 0);
            fill(compliances_, static_cast<float>(1.0 / attachment.stiffness));
            for (const auto& [a, b] : ties) {
                lengths_.push_back(
                    static_cast<float>(length(part.rest[static_cast<std::size_t>(a)] -
                                              part.rest[static_cast<std::size_t>(b)])));
            }
        }
    }

    std::unique_ptr<ElementFamily> build(const Strips& strips,
                                         std::span<const Vec3> /*rest*/) const override {
        return std::make_unique<Springs>(names(), stencils(), strips, lengths_, compliances_,
                                         edge_count_);
    }

    void add_resistance(std::span<const Vec3> rest, Vec3 along,
                        std::span<double> resistance) const override {
        for (int s = 0; s < edge_count_; ++s) {
            const auto i = static_cast<std::size_t>(s);
            const auto a = static_cast<std::size_t>(stencils()[s][0]);
            const auto b = static_cast<std::size_t>(stencils()[s][1]);
            const Vec3 edge = rest[b] - rest[a];
            if (length(edge) == 0.0) continue;
            const double cosine = dot(normalized(edge), along);
            const double change = static_cast<double>(lengths_[i]) * cosine * cosine;
            const double half = 0.5 * change * change / static_cast<double>(compliances_[i]);
            resistance[a] += half;
            resistance[b] += half;
        }
    }

    std::vector<Absence> absences(const Scene& scene, bool exists) const override {
        std::vector<Absence> list;
        if (!exists) {
            list.push_back({"springs", "no cloth has stretch.stiffness, and nothing is attached"});
        }
        if (scene.attachments.empty()) {
            list.push_back({"attachments", "the scene has no [[attachment]]", false});
        }
        return list;
    }

private:
    // As the tables will have them: there are millions.
    std::vector<float> lengths_;      ///< [springs] at rest [m]
    std::vector<float> compliances_;  ///< [springs] [m/N]
    int edge_count_ = 0;
};

}  // namespace

std::unique_ptr<FamilyBuilder> make_springs_builder() { return std::make_unique<SpringsBuilder>(); }

}  // namespace weft
