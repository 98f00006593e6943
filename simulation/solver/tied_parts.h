#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/step.h"
#include "simulation/model/model.h"
#include "simulation/solver/part_columns.h"
#include "simulation/solver/part_ties.h"

namespace weft {

/// Leads bodies that soft springs tie to others, as wholes, to where a substep's iterations begin
/// (kernels/bodies/ties.h). One task, as all of a part has to be known.
class TiedParts {
public:
    /// Null: nothing ties two bodies.
    /// targets  [vertices] x~
    static std::unique_ptr<TiedParts> of(Model& model, Buffer<float4>& targets, int kind);

    static std::vector<std::string> kinds() { return {"ties"}; }
    const TaskBody& body() const { return body_; }
    /// Behind the beginnings of all regions.
    void add(Step& step);

private:
    /// Table and columns of its vertices and of its ties.
    struct Layout {
        Layout(TieTable found, const Model& model);
        int part_count() const { return static_cast<int>(table.vertices.size()); }

        TieTable table;
        std::vector<double> masses;  ///< [parts] [kg]
        std::vector<int> vertices;   ///< part by part
        std::vector<int> parts;      ///< whose each is
        PartColumns members, ties;
    };
    /// Items that are all in strip 0.
    struct Items {
        Items(const char* name, int count, int strips);
        Segments segments() const { return {&begin, 0, 1, static_cast<int>(begin.count()) - 1}; }

        Buffer<int> begin;  ///< [strips + 1]
    };

    TiedParts(Model& model, const Layout& layout, Buffer<float4>& targets, int kind);
    void fill_members(const Layout& layout);
    void fill_ties(const Layout& layout);
    void fill_parts(const Layout& layout);
    std::vector<Launch> launches(int rounds);

    Model& model_;
    Buffer<float4>& targets_;
    int part_count_;
    // As kernels/bodies/moments.h and ties.h want them.
    Buffer<int> vertices_, vertex_parts_;
    Buffer<int> member_rows_, members_;
    Buffer<float> shares_;
    Buffer<int> tie_rows_, ends_, end_parts_;
    Buffer<float> springs_;
    Buffer<int> origins_;
    Buffer<int> first_, sum_starts_, sum_places_;
    Buffer<float> still_;  ///< [substeps] a clock for those that do not change
    Buffer<float4> partials_, sums_, pulls_, motions_;
    Items each_vertex_, each_column_, each_sum_, each_part_;
    TaskBody body_;
};

}  // namespace weft
