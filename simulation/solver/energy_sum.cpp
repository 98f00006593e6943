#include "simulation/solver/energy_sum.h"

#include <algorithm>

#include "kernels/descent/energy_terms.h"
#include "scheduler/assert.h"

namespace weft {

EnergySum::EnergySum(Model& model, Buffer<float4>& targets, ContactEnergy* contacts)
    : model_(model),
      targets_(targets),
      contacts_(contacts),
      used_(static_cast<std::size_t>(model.strips.count()), 0),
      columns_("energy.columns", 2 * kColumns * used_.size()),
      column_begin_("energy.strips", used_.size() + 1),
      partials_("energy.partials", kColumns * used_.size()) {
    vertices_ = make_vertices_part("inertia.terms");
    for (const auto& family : model.families) families_.push_back(make_part(*family));
    if (contacts_ != nullptr) touching_ = make_vertices_part("contact.terms");
    place_strips();
}

std::unique_ptr<EnergySum::Part> EnergySum::make_part(const ElementFamily& family) {
    const int strips = model_.strips.count();
    auto part = std::make_unique<Part>(family.names().name + ".terms", family.count(),
                                       kPhaseCount * (strips + 1));
    for (const Phase phase : {kSeamPhase, kInnerPhase}) {
        const int first = phase * (strips + 1);
        for (int s = 0; s <= strips; ++s) {
            part->strip_begin[static_cast<std::size_t>(first + s)] =
                family.elements().segments(phase).item(s, 0);
        }
        part->items.push_back({&part->strip_begin, first, 1, strips});
    }
    take_places(*part);
    return part;
}

std::unique_ptr<EnergySum::Part> EnergySum::make_vertices_part(const std::string& name) {
    const auto& begin = model_.strips.begin;
    auto part = std::make_unique<Part>(name, model_.vertex_count(), static_cast<int>(begin.size()));
    std::copy(begin.begin(), begin.end(), part->strip_begin.data());
    part->items.push_back({&part->strip_begin, 0, 1, model_.strips.count()});
    take_places(*part);
    return part;
}

void EnergySum::take_places(Part& part) {
    for (const Segments& items : part.items) {
        for (int s = 0; s < items.strip_count; ++s) {
            for (int i = items.item(s); i < items.item(s + 1); ++i) {
                part.slots[static_cast<std::size_t>(i)] = used_[static_cast<std::size_t>(s)]++;
            }
        }
    }
}

/// Strips one behind the other, each filled up to whole rows of columns; what fills is 0 for ever.
void EnergySum::place_strips() {
    std::vector<int> base{0};
    for (std::size_t s = 0; s < used_.size(); ++s) {
        const int rows = (used_[s] + kColumns - 1) / kColumns;
        column_begin_[s] = static_cast<int>(s) * kColumns;
        for (std::size_t c = 0; c < kColumns; ++c) {
            columns_[2 * (s * kColumns + c)] = base.back() + static_cast<int>(c);
            columns_[2 * (s * kColumns + c) + 1] = rows;
        }
        base.push_back(base.back() + rows * kColumns);
    }
    WEFT_ASSERT(std::ranges::is_sorted(base));
    column_begin_[used_.size()] = static_cast<int>(used_.size()) * kColumns;
    terms_ = std::make_unique<Buffer<float>>("energy.terms", static_cast<std::size_t>(base.back()));
    move_into_strips(*vertices_, base);
    for (const auto& part : families_) move_into_strips(*part, base);
    if (touching_) move_into_strips(*touching_, base);
}

/// base: [strips] where each one's terms begin
void EnergySum::move_into_strips(Part& part, const std::vector<int>& base) {
    for (const Segments& items : part.items) {
        for (int s = 0; s < items.strip_count; ++s) {
            for (int i = items.item(s); i < items.item(s + 1); ++i) {
                part.slots[static_cast<std::size_t>(i)] += base[static_cast<std::size_t>(s)];
            }
        }
    }
}

std::vector<Launch> EnergySum::launches(Buffer<float4>& positions) {
    std::vector<Launch> launches{launch(kernels::inertia_terms, vertices_->items[0], positions,
                                        targets_, vertices_->slots, *terms_,
                                        static_cast<float>(1.0 / (model_.h * model_.h)))};
    for (const Phase phase : {kSeamPhase, kInnerPhase}) {
        for (std::size_t f = 0; f < families_.size(); ++f) {
            Part& part = *families_[f];
            launches.push_back(model_.families[f]->energy_terms(
                {part.items[phase], positions, part.slots, *terms_}));
        }
    }
    if (touching_) launches.push_back(contacts_->terms(positions, touching_->slots, *terms_));
    const Segments columns{&column_begin_, 0, 1, model_.strips.count()};
    launches.push_back(launch(kernels::add_terms, columns, *terms_, columns_, partials_, kColumns));
    return launches;
}

}  // namespace weft
