// An own reader, since a wrong mesh must be refused at its line: tinyobjloader gives no lines for
// what it read, and reads a coordinate that is not a number as 0.
#include "simulation/mesh/obj_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "runtime/error.h"
#include "simulation/mesh/mesh_text.h"
#include "simulation/mesh/parse_number.h"

namespace weft {
namespace {

// Triangles refer to vertices by int32, and edges and corners must still be counted by one.
constexpr std::size_t kMaxElements = 100'000'000;

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }

class ObjParser {
public:
    ObjParser(const std::string& path, Warnings& warnings) : path_(path), warnings_(warnings) {
        mesh_.source = path;
    }

    TriangleMesh parse(std::string_view text) {
        reserve(text.size());
        while (!text.empty()) {
            const std::size_t end = std::min(text.find('\n'), text.size());
            ++line_;
            parse_line(text.substr(0, end));
            text.remove_prefix(std::min(end + 1, text.size()));
        }
        finish();
        return std::move(mesh_);
    }

private:
    [[noreturn]] void fail(const std::string& what) const {
        throw UserError(fmt::format("{}:{}: {}", path_, line_, what));
    }

    /// A line of a vertex or a face takes 30 bytes or more in most files; a hint, not a bound.
    void reserve(std::size_t bytes) {
        mesh_.positions.reserve(bytes / 90);
        mesh_.triangles.reserve(bytes / 45);
    }

    void parse_line(std::string_view line) {
        line = line.substr(0, line.find('#'));
        while (!line.empty() && is_space(line.back())) line.remove_suffix(1);
        if (line.ends_with('\\')) fail("a line continued by '\\' is not supported; join the lines");
        std::string_view rest = line;
        const std::string_view keyword = next_word(rest);
        if (keyword.empty()) return;
        if (keyword == "v") return parse_vertex(rest);
        if (keyword == "f") return parse_face(rest);
        if (keyword == "g" || keyword == "o") return start_part(rest);
        if (!is_passed_over(keyword)) ++unknown_lines_;
    }

    static bool is_passed_over(std::string_view keyword) {
        for (const char* known : {"vt", "vn", "vp", "s", "usemtl", "mtllib", "l", "p", "mg"}) {
            if (keyword == known) return true;
        }
        return false;
    }

    double parse_coordinate(std::string_view word, char axis) const {
        if (word.empty())
            fail(fmt::format("a vertex needs three coordinates, {} is missing", axis));
        const std::optional<double> value = parse_number(word);
        if (!value) fail(fmt::format("coordinate {} = {}: expected a number", axis, quoted(word)));
        if (!(std::abs(*value) <= kMaxCoordinate)) {
            fail(fmt::format("coordinate {} = {}: must be finite and within {} m", axis,
                             quoted(word), kMaxCoordinate));
        }
        return *value;
    }

    void parse_vertex(std::string_view rest) {
        Vec3 position;
        position.x = parse_coordinate(next_word(rest), 'x');
        position.y = parse_coordinate(next_word(rest), 'y');
        position.z = parse_coordinate(next_word(rest), 'z');
        if (mesh_.positions.size() == kMaxElements) fail("too many vertices");
        mesh_.positions.push_back(position);
    }

    /// A corner is "v", "v/vt", "v//vn" or "v/vt/vn"; only v matters here.
    int parse_corner(std::string_view word) const {
        std::int64_t index = 0;
        const char* const last = word.data() + word.size();
        const auto [end, error] = std::from_chars(word.data(), last, index);
        const bool well_formed = error == std::errc{} && (end == last || *end == '/');
        if (!well_formed) fail(fmt::format("{}: expected a vertex index", quoted(word)));
        const auto count = static_cast<std::int64_t>(mesh_.positions.size());
        if (index == 0 || index > kMaxIndex || index < -count) {
            fail(
                fmt::format("vertex index {} is out of range: {} vertices so far, counted from 1 "
                            "(or from -1 backwards)",
                            index, count));
        }
        return static_cast<int>(index > 0 ? index - 1 : count + index);
    }

    void parse_face(std::string_view rest) {
        std::array<int, 3> triangle{};
        std::size_t corners = 0;
        for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
            if (corners < 3) triangle[corners] = parse_corner(word);
            ++corners;
        }
        if (corners != 3) {
            fail(
                fmt::format("face with {} corners: only triangles are supported; triangulate the "
                            "mesh when exporting it",
                            corners));
        }
        const auto [a, b, c] = triangle;
        if (a == b || b == c || c == a) {
            fail(fmt::format("degenerate triangle {} {} {}: a vertex is named twice", a + 1, b + 1,
                             c + 1));
        }
        if (mesh_.triangles.size() == kMaxElements) fail("too many triangles");
        if (std::max({a, b, c}) > highest_index_) {
            highest_index_ = std::max({a, b, c});
            highest_index_line_ = line_;
        }
        mesh_.triangles.push_back(triangle);
    }

    void start_part(std::string_view name) {
        while (!name.empty() && is_space(name.front())) name.remove_prefix(1);
        end_part();
        part_name_ = name;
    }

    void end_part() {
        const int count = mesh_.triangle_count() - part_begin_;
        if (count > 0) mesh_.parts.push_back({part_name_, part_begin_, count});
        part_begin_ = mesh_.triangle_count();
    }

    void finish() {
        end_part();
        if (mesh_.positions.empty()) throw UserError(path_ + ": has no vertices ('v' lines)");
        if (mesh_.triangles.empty()) throw UserError(path_ + ": has no triangles ('f' lines)");
        // A face may come before its vertices, so only now is it known what is out of range.
        if (highest_index_ >= mesh_.vertex_count()) {
            line_ = highest_index_line_;
            fail(
                fmt::format("vertex index {} is out of range: the file has {} vertices, counted "
                            "from 1",
                            highest_index_ + 1, mesh_.vertex_count()));
        }
        if (unknown_lines_ > 0) {
            warnings_.push_back(fmt::format("{}: {} lines with unknown keywords passed over", path_,
                                            unknown_lines_));
        }
    }

    static constexpr std::int64_t kMaxIndex = kMaxElements;

    const std::string& path_;
    Warnings& warnings_;
    TriangleMesh mesh_;
    std::size_t line_ = 0;
    std::size_t unknown_lines_ = 0;
    std::string part_name_;
    int part_begin_ = 0;
    int highest_index_ = -1;
    std::size_t highest_index_line_ = 0;
};

}  // namespace

TriangleMesh parse_obj(std::string_view text, const std::string& path, Warnings& warnings) {
    return ObjParser(path, warnings).parse(text);
}

TriangleMesh read_obj(const std::string& path, Warnings& warnings) {
    return parse_obj(read_mesh_text(path, "an OBJ mesh"), path, warnings);
}

}  // namespace weft
