#include "simulation/solver/newton/hessian.h"

#include <algorithm>
#include <limits>
#include <string>

#include "kernels/newton/blocks.h"
#include "runtime/error.h"
#include "runtime/tbb/parallel.h"
#include "simulation/solver/accesses.h"

namespace weft {

namespace {

/// How many others each row has.
std::vector<int> lengths_of(const Couplings& couplings) {
    std::vector<int> lengths(static_cast<std::size_t>(couplings.vertex_count()));
    for_each_block(couplings.vertex_count(), [&](int /*block*/, int begin, int end) {
        for (int v = begin; v < end; ++v) {
            lengths[static_cast<std::size_t>(v)] = couplings.other_count(v);
        }
    });
    return lengths;
}

}  // namespace

FamilyHessian::FamilyHessian(ElementFamily& family, const VertexItems& items, const Model& model)
    : FamilyHessian(family, items, model, Couplings(family.elements(), model.vertex_count())) {}

FamilyHessian::FamilyHessian(ElementFamily& family, const VertexItems& items, const Model& model,
                             const Couplings& couplings)
    : vertex_count_(model.vertex_count()),
      columns_(family.block_columns()),
      rows_(family.names().name + ".blocks.rows", items.segment_begin(), lengths_of(couplings)),
      others_(family.names().name + ".blocks.others",
              static_cast<std::size_t>(rows_.entry_count())),
      entry_begin_(family.names().name + ".blocks.strips", model.strips.begin.size()),
      vertices_(model.vertices()),
      entries_{&entry_begin_, 0, 1, model.strips.count()},
      gradients_(family.is_quadratic() ? nullptr : family.make_rows(items)),
      contributions_(family.make_block_rows(place(couplings, model.strips))) {
    if (contributions_->constant_blocks() != nullptr) return;
    made_ = std::make_unique<Buffer<float>>(family.names().name + ".blocks",
                                            others_.count() * static_cast<std::size_t>(columns_));
}

/// Fills the tables of rows, and lists what contributes to each entry.
BlockList FamilyHessian::place(const Couplings& couplings, const Strips& strips) {
    constexpr std::size_t kMost = std::numeric_limits<int>::max();
    BlockList list;
    list.contributions = couplings.all();
    if (list.contributions.size() > kMost) {
        throw RunError("the Hessian would need more than " + std::to_string(kMost) + " terms");
    }
    list.ranges.resize(others_.count());
    for_each_block(vertex_count_, [&](int /*block*/, int first, int last) {
        for (int v = first; v < last; ++v) place_row(v, couplings, list);
    });
    for (std::size_t s = 0; s < strips.begin.size(); ++s) {
        const int first = strips.begin[s];
        entry_begin_[s] =
            first < vertex_count_ ? static_cast<int>(rows_.entry(first, 0)) : rows_.entry_count();
    }
    const auto begins = entry_begin_.span();
    list.segment_begin.assign(begins.begin(), begins.end());
    return list;
}

void FamilyHessian::place_row(int v, const Couplings& couplings, BlockList& list) {
    int k = 0;
    couplings.for_each_other(v, [&](int other, std::span<const Coupling> own) {
        const std::size_t entry = rows_.entry(v, k++);
        others_[entry] = other;
        list.ranges[entry] = {static_cast<int>(own.data() - list.contributions.data()),
                              static_cast<int>(own.size())};
    });
    const int room = rows_.room(v);
    for (; k < room; ++k) others_[rows_.entry(v, k)] = v;
}

Launch FamilyHessian::gather_gradients(const DerivativeTarget& t) {
    return gradients_ ? gradients_->gather_gradients(t) : multiply(t.positions, t.sums, t.fresh);
}

std::vector<Launch> FamilyHessian::couple(const LinearisedAt& where) {
    if (!made_) return {};
    return contributions_->couple({entries_, where.positions, where.before, where.after, *made_,
                                   rows_.entry_count(), columns_, 1});
}

Launch FamilyHessian::sum_rows(Buffer<float>& sums, int fresh) {
    return launch(kernels::sum_block_rows, vertices_, rows_.slices(), blocks(), sums, vertex_count_,
                  rows_.entry_count(), columns_, SlicedRows::kStride, fresh);
}

Launch FamilyHessian::multiply(Buffer<float4>& directions, Buffer<float>& products, int fresh) {
    if (columns_ == 1) {
        return launch(kernels::multiply_scalar_blocks, vertices_, directions, rows_.slices(),
                      others_, blocks(), products, vertex_count_, SlicedRows::kStride, fresh);
    }
    const auto multiply_by = [&](auto kernel) {
        return launch(kernel, vertices_, directions, rows_.slices(), others_, blocks(), products,
                      vertex_count_, rows_.entry_count(), SlicedRows::kStride, fresh);
    };
    return columns_ == 6 ? multiply_by(kernels::multiply_symmetric_blocks)
                         : multiply_by(kernels::multiply_blocks);
}

void FamilyHessian::add_accesses(Step::Adding& task, int first_strip, int end_strip, bool writes) {
    if (!made_) return;
    add_columns(task, *made_, rows_.entry_count(), columns_, entries_.item(first_strip),
                entries_.item(end_strip), writes);
}

Hessian::Hessian(Model& model, VertexItems& items) : items_(items) {
    families_.resize(model.families.size());
    for_each_apart(static_cast<int>(families_.size()), [&](int f) {
        const auto i = static_cast<std::size_t>(f);
        families_[i] = std::make_unique<FamilyHessian>(*model.families[i], items, model);
    });
}

std::vector<Launch> Hessian::gather_gradients(Buffer<float4>& positions, Buffer<float>& sums) {
    std::vector<Launch> launches;
    for (const auto& family : families_) {
        launches.push_back(
            family->gather_gradients({items_.segments(kInnerPhase), positions, items_.vertices(),
                                      sums, items_.count(), launches.empty() ? 1 : 0}));
    }
    return launches;
}

std::vector<Launch> Hessian::couple(const LinearisedAt& where) {
    std::vector<Launch> launches;
    for (const auto& family : families_)
        std::ranges::move(family->couple(where), std::back_inserter(launches));
    return launches;
}

std::vector<Launch> Hessian::sum_rows(Buffer<float>& sums) {
    std::vector<Launch> launches;
    for (const auto& family : families_) {
        launches.push_back(family->sum_rows(sums, launches.empty() ? 1 : 0));
    }
    return launches;
}

std::vector<Launch> Hessian::multiply(Buffer<float4>& directions, Buffer<float>& products) {
    std::vector<Launch> launches;
    for (const auto& family : families_) {
        launches.push_back(family->multiply(directions, products, launches.empty() ? 1 : 0));
    }
    return launches;
}

std::vector<BufferStorage*> Hessian::scratch() {
    std::vector<BufferStorage*> buffers;
    for (const auto& family : families_) {
        if (BufferStorage* blocks = family->scratch()) buffers.push_back(blocks);
    }
    return buffers;
}

void Hessian::add_accesses(Step::Adding& task, int first_strip, int end_strip, bool writes) {
    for (const auto& family : families_) family->add_accesses(task, first_strip, end_strip, writes);
}

}  // namespace weft
