#pragma once

#include <array>
#include <memory>
#include <vector>

#include "simulation/contact/energy.h"
#include "simulation/model/model.h"

namespace weft {

/// E(x) on the devices, as sums that are the same whoever adds them up: 64 per strip. See
/// kernels/descent/energy_terms.h.
class EnergySum {
public:
    static constexpr int kColumns = 64;

    /// contacts: null: there are none
    EnergySum(Model& model, Buffer<float4>& targets, ContactEnergy* contacts = nullptr);

    /// What writes the sums of a strip for these positions.
    std::vector<Launch> launches(Buffer<float4>& positions);
    /// [kColumns * strips] E is the sum of them all [J].
    Buffer<float>& partials() { return partials_; }
    /// What the launches make anew.
    BufferStorage& terms() { return *terms_; }

private:
    /// The terms of one kind of item.
    struct Part {
        Part(const std::string& name, int item_count, int table_size)
            : slots(name + ".slots", static_cast<std::size_t>(item_count)),
              strip_begin(name + ".strips", static_cast<std::size_t>(table_size)) {}

        Buffer<int> slots;            ///< [items] in terms_
        Buffer<int> strip_begin;      ///< one segment per strip, for each phase
        std::vector<Segments> items;  ///< [phases]
    };
    std::unique_ptr<Part> make_part(const ElementFamily& family);
    std::unique_ptr<Part> make_vertices_part(const std::string& name);
    /// Gives the part's items their places behind those that each strip already has.
    void take_places(Part& part);
    void place_strips();
    void move_into_strips(Part& part, const std::vector<int>& base);

    Model& model_;
    Buffer<float4>& targets_;
    ContactEnergy* contacts_;
    std::vector<int> used_;  ///< [strips] terms
    std::unique_ptr<Part> vertices_;
    std::vector<std::unique_ptr<Part>> families_;  ///< as the model's
    std::unique_ptr<Part> touching_;               ///< vertices that contacts count at; null: none
    std::unique_ptr<Buffer<float>> terms_;
    Buffer<int> columns_;       ///< [2 * kColumns * strips]
    Buffer<int> column_begin_;  ///< [strips + 1]
    Buffer<float> partials_;
};

}  // namespace weft
