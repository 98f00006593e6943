// Legacy VTK files: docs.vtk.org, "VTK File Formats", Simple Legacy Formats.
#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "runtime/error.h"
#include "simulation/mesh/tet_builder.h"
#include "simulation/mesh/tet_reader.h"

namespace weft {
namespace {

constexpr std::int64_t kVtkTetra = 10;

CellKind kind_of(std::int64_t type) {
    if (type == kVtkTetra) return CellKind::kTetrahedron;
    // Vertices, lines and polygons, and their quadratic forms.
    const bool is_flat = (type >= 0 && type <= 9) || (type >= 21 && type <= 23) || type == 28 ||
                         type == 30 || type == 34 || type == 35 || type == 36;
    return is_flat ? CellKind::kFlat : CellKind::kOtherSolid;
}

class VtkParser {
public:
    VtkParser(std::string_view text, const std::string& path)
        : words_(text, path), builder_(path) {}

    TetMesh parse() {
        parse_head();
        while (!words_.at_end() && !has_types_) parse_section();
        if (!has_types_) words_.fail("the file ends here, expected CELLS and CELL_TYPES");
        expect_no_more_types();
        return builder_.finish();
    }

private:
    void parse_head() {
        if (!words_.rest_of_line().starts_with("# vtk DataFile Version")) {
            words_.fail(
                "is not a legacy VTK file: the first line must be '# vtk DataFile Version'");
        }
        words_.next_line();
        words_.next_line();  // the title
        const std::string_view encoding = words_.word("ASCII");
        if (encoding == "BINARY") {
            words_.fail("is a binary VTK file, which is not supported; save it as ASCII");
        }
        expect(encoding, "ASCII");
        expect(words_.word("DATASET"), "DATASET");
        const std::string_view kind = words_.word("UNSTRUCTURED_GRID");
        if (kind != "UNSTRUCTURED_GRID") {
            words_.fail(
                fmt::format("dataset {}: a solid needs an UNSTRUCTURED_GRID", quoted(kind)));
        }
    }

    void expect(std::string_view word, std::string_view expected) {
        if (word != expected) {
            words_.fail(fmt::format("{}: expected {}", quoted(word), expected));
        }
    }

    void parse_section() {
        const std::string_view keyword = words_.word("a section");
        if (keyword == "POINTS") return parse_points();
        if (keyword == "CELLS") return parse_cells();
        if (keyword == "CELL_TYPES") return parse_types();
        if (keyword == "METADATA") return skip_metadata();
        if (keyword == "FIELD") return skip_field();
        words_.fail(fmt::format("{}: expected POINTS, CELLS or CELL_TYPES", quoted(keyword)));
    }

    void parse_points() {
        if (!builder_.mesh().positions.empty()) words_.fail("POINTS come a second time");
        const std::size_t count = words_.count("the number of points", 6);
        words_.word("the points' type");
        for (std::size_t i = 0; i < count; ++i) builder_.add_vertex(words_.position());
    }

    /// Up to version 5.0: "CELLS cells words", then each cell's size and points. From 5.1 on:
    /// "CELLS offsets points", then the keywords OFFSETS and CONNECTIVITY.
    void parse_cells() {
        if (!begin_.empty()) words_.fail("CELLS come a second time");
        const std::size_t first = words_.count("the number of cells", 2);
        const std::size_t second = words_.count("the size of the cells", 2);
        if (first == 0) {
            expect_sum("CELLS", second, 0);
            return begin_.push_back(0);
        }
        const std::string_view word = words_.word("the cells");
        if (word == "OFFSETS") return parse_offsets(first, second);
        begin_.push_back(0);
        std::int64_t size = 0;
        for (std::size_t cell = 0; cell < first; ++cell) {
            size = cell == 0 ? integer_of(word) : words_.integer("a cell's number of points");
            if (size < 0 ||
                points_.size() + begin_.size() + static_cast<std::uint64_t>(size) > second) {
                words_.fail(fmt::format("a cell of {} points: CELLS promised {} numbers in all",
                                        size, second));
            }
            for (std::int64_t k = 0; k < size; ++k) points_.push_back(words_.integer("a point"));
            begin_.push_back(points_.size());
        }
        expect_sum("CELLS", second, points_.size() + first);
    }

    /// What a keyword promises in advance, against what there was.
    void expect_sum(const char* keyword, std::size_t promised, std::size_t found) const {
        if (found == promised) return;
        words_.fail(fmt::format("{} promised {} numbers in all, and there are {}", keyword,
                                promised, found));
    }

    std::int64_t integer_of(std::string_view word) {
        std::int64_t value = 0;
        for (const char c : word) {
            if (c < '0' || c > '9' || value > 1'000'000) {
                words_.fail(fmt::format("{}: expected a cell's number of points", quoted(word)));
            }
            value = 10 * value + (c - '0');
        }
        return value;
    }

    void parse_offsets(std::size_t offsets, std::size_t points) {
        words_.word("the offsets' type");
        for (std::size_t i = 0; i < offsets; ++i) {
            const std::int64_t offset = words_.integer("an offset");
            const std::size_t least = begin_.empty() ? 0 : begin_.back();
            if (offset < 0 || static_cast<std::size_t>(offset) < least ||
                static_cast<std::size_t>(offset) > points || (i == 0 && offset != 0)) {
                words_.fail(
                    fmt::format("offset {}: offsets must rise from 0 to {}", offset, points));
            }
            begin_.push_back(static_cast<std::size_t>(offset));
        }
        if (begin_.back() != points) {
            words_.fail(fmt::format("the last offset is {}: it must be {}, as CELLS promised",
                                    begin_.back(), points));
        }
        expect(words_.word("CONNECTIVITY"), "CONNECTIVITY");
        words_.word("the connectivity's type");
        for (std::size_t i = 0; i < points; ++i) points_.push_back(words_.integer("a point"));
        if (begin_.empty()) begin_.push_back(0);
    }

    void parse_types() {
        if (begin_.empty()) words_.fail("CELL_TYPES before CELLS");
        const std::size_t count = words_.count("the number of cell types", 2);
        if (count + 1 != begin_.size()) {
            words_.fail(fmt::format("{} cell types for {} cells", count, begin_.size() - 1));
        }
        for (std::size_t cell = 0; cell < count; ++cell) {
            const std::int64_t type = words_.integer("a cell type");
            switch (kind_of(type)) {
                case CellKind::kTetrahedron:
                    add_tetrahedron(cell);
                    break;
                case CellKind::kFlat:
                    break;
                case CellKind::kOtherSolid:
                    words_.fail(
                        fmt::format("cell {} (from 0) has type {}: only tetrahedra with 4 "
                                    "points (type 10) are supported",
                                    cell, type));
            }
        }
        has_types_ = true;
    }

    /// What comes behind them is not read, but for how it begins.
    void expect_no_more_types() {
        if (words_.at_end()) return;
        const std::string_view word = words_.word("a section");
        if (std::isalpha(static_cast<unsigned char>(word.front())) != 0) return;
        words_.fail(fmt::format("{}: CELL_TYPES promised {} types, and they were before this",
                                quoted(word), begin_.size() - 1));
    }

    void add_tetrahedron(std::size_t cell) {
        const std::span<const std::int64_t> points(points_.data() + begin_[cell],
                                                   begin_[cell + 1] - begin_[cell]);
        if (points.size() != 4) {
            words_.fail(fmt::format("cell {} (from 0) is a tetrahedron of {} points, must be 4",
                                    cell, points.size()));
        }
        std::array<int, 4> vertices{};
        for (std::size_t k = 0; k < 4; ++k) {
            if (points[k] < 0 || points[k] >= builder_.mesh().vertex_count()) {
                words_.fail(
                    fmt::format("cell {} (from 0): point {} is out of range: the file has {} "
                                "points, counted from 0",
                                cell, points[k], builder_.mesh().vertex_count()));
            }
            vertices[k] = static_cast<int>(points[k]);
        }
        builder_.add_tetrahedron(vertices, points, words_);
    }

    /// Ends at an empty line.
    void skip_metadata() {
        words_.next_line();
        while (!words_.next_line().empty()) {
        }
    }

    /// "FIELD name arrays", then for each array "name components tuples type" and the values.
    void skip_field() {
        words_.word("a field's name");
        const std::size_t arrays = words_.count("the number of arrays", 2);
        for (std::size_t a = 0; a < arrays; ++a) {
            words_.word("an array's name");
            const std::size_t components = words_.count("the number of components", 1);
            const std::size_t tuples = words_.count("the number of tuples", 1);
            words_.word("an array's type");
            for (std::size_t t = 0; t < tuples; ++t) {
                for (std::size_t c = 0; c < components; ++c) words_.word("a value");
            }
        }
    }

    MeshWords words_;
    TetBuilder builder_;
    std::vector<std::size_t> begin_;    ///< where each cell begins in points_, and the end
    std::vector<std::int64_t> points_;  ///< of all cells
    bool has_types_ = false;
};

}  // namespace

TetMesh parse_vtk(std::string_view text, const std::string& path) {
    return VtkParser(text, path).parse();
}

}  // namespace weft
