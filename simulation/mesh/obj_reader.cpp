// An own reader, since a wrong mesh must be refused at its line: tinyobjloader gives no lines for
// what it read, and reads a coordinate that is not a number as 0.
#include "simulation/mesh/obj_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "runtime/error.h"
#include "simulation/mesh/mesh_format.h"
#include "simulation/mesh/mesh_text.h"
#include "simulation/mesh/parse_number.h"

namespace weft {
namespace {

// Triangles refer to vertices by int32, and edges and corners must still be counted by one.
constexpr std::size_t kMaxElements = 100'000'000;
// Splitting takes the square of it.
constexpr std::size_t kMaxCorners = 1000;

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }

class ObjParser {
public:
    ObjParser(const std::string& path, Warnings& warnings) : path_(path), warnings_(warnings) {
        mesh_.source = path;
    }

    ObjFaces parse(std::string_view text) {
        reserve(text.size());
        while (!text.empty()) {
            const std::size_t end = std::min(text.find('\n'), text.size());
            ++line_;
            parse_line(text.substr(0, end));
            text.remove_prefix(std::min(end + 1, text.size()));
        }
        finish();
        return {std::move(mesh_), std::move(face_lines_)};
    }

private:
    [[noreturn]] void fail(const std::string& what) const {
        throw UserError(fmt::format("{}:{}: {}", path_, line_, what));
    }

    /// A line of a vertex or a face takes 30 bytes or more in most files; a hint, not a bound.
    void reserve(std::size_t bytes) {
        mesh_.positions.reserve(bytes / 90);
        mesh_.corners.reserve(bytes / 15);
    }

    void parse_line(std::string_view line) {
        line = line.substr(0, line.find('#'));
        while (!line.empty() && is_space(line.back())) line.remove_suffix(1);
        if (line.ends_with('\\')) fail("a line continued by '\\' is not supported; join the lines");
        std::string_view rest = line;
        const std::string_view keyword = next_word(rest);
        if (keyword.empty()) return;
        if (keyword == "v") return parse_vertex(rest);
        if (keyword == "vt") return parse_texture_point(rest);
        if (keyword == "f") return parse_face(rest);
        if (keyword == "g") return start_group(rest);
        if (keyword == "o") return start_object(rest);
        if (!is_passed_over(keyword)) ++unknown_lines_;
    }

    static bool is_passed_over(std::string_view keyword) {
        for (const char* known : {"vn", "vp", "s", "usemtl", "mtllib", "l", "p", "mg"}) {
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

    /// "vt u", "vt u v" or "vt u v w"; w does not matter here.
    void parse_texture_point(std::string_view rest) {
        std::array<double, 2> uv{};
        for (double& value : uv) {
            const std::string_view word = next_word(rest);
            if (word.empty()) break;
            const std::optional<double> number = parse_number(word);
            if (!number || !std::isfinite(*number)) return bad_texture_.note(0, line_);
            value = *number;
        }
        mesh_.texture.push_back(uv);
    }

    struct Corner {
        int vertex;
        int texture;  ///< -1: none
    };

    /// The number that `text` begins with, up to a slash or its end; none where it is none.
    static std::optional<std::int64_t> parse_integer(std::string_view text) {
        std::int64_t number = 0;
        const char* const last = text.data() + text.size();
        const auto [end, error] = std::from_chars(text.data(), last, number);
        if (error != std::errc{} || (end != last && *end != '/')) return std::nullopt;
        return number;
    }

    /// An index from 0, for one that counts from 1, or from -1 backwards; none where it names
    /// nothing so far.
    static std::optional<int> from_zero(std::int64_t index, std::size_t known) {
        const auto count = static_cast<std::int64_t>(known);
        if (index == 0 || index > kMaxIndex || index < -count) return std::nullopt;
        return static_cast<int>(index > 0 ? index - 1 : count + index);
    }

    /// A corner is "v", "v/vt", "v//vn" or "v/vt/vn"; vn does not matter here.
    Corner parse_corner(std::string_view word) {
        Corner corner{parse_vertex_index(word), -1};
        const std::size_t slash = word.find('/');
        if (slash == word.npos || slash + 1 == word.size() || word[slash + 1] == '/') return corner;
        const auto index = parse_integer(word.substr(slash + 1));
        const auto texture = index ? from_zero(*index, mesh_.texture.size()) : std::nullopt;
        if (texture)
            corner.texture = *texture;
        else
            bad_texture_.note(0, line_);
        return corner;
    }

    int parse_vertex_index(std::string_view word) const {
        const auto index = parse_integer(word);
        if (!index) fail(fmt::format("{}: expected a vertex index", quoted(word)));
        const auto vertex = from_zero(*index, mesh_.positions.size());
        if (!vertex) {
            fail(
                fmt::format("vertex index {} is out of range: {} vertices so far, counted from 1 "
                            "(or from -1 backwards)",
                            *index, mesh_.positions.size()));
        }
        return *vertex;
    }

    void parse_face(std::string_view rest) {
        face_.clear();
        for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
            face_.push_back(parse_corner(word));
        }
        if (face_.size() > 3) drop_repeated_neighbours();
        if (face_.size() < 3) {
            fail(fmt::format("face with {} corners: it takes three or more", face_.size()));
        }
        if (face_.size() > kMaxCorners) {
            fail(
                fmt::format("face with {} corners: more than {} are not supported; triangulate "
                            "the mesh when exporting it",
                            face_.size(), kMaxCorners));
        }
        refuse_repeated();
        add_face();
    }

    /// Some exporters write a triangle as a quad with two corners in one vertex.
    void drop_repeated_neighbours() {
        const auto same = [](const Corner& a, const Corner& b) { return a.vertex == b.vertex; };
        face_.erase(std::unique(face_.begin(), face_.end(), same), face_.end());
        if (face_.size() > 3 && same(face_.front(), face_.back())) face_.pop_back();
    }

    void refuse_repeated() {
        sorted_.clear();
        for (const Corner& corner : face_) sorted_.push_back(corner.vertex);
        std::sort(sorted_.begin(), sorted_.end());
        const auto twice = std::adjacent_find(sorted_.begin(), sorted_.end());
        if (twice == sorted_.end()) return;
        fail(fmt::format("degenerate face: vertex {} is named twice", *twice + 1));
    }

    void add_face() {
        if (mesh_.corners.size() > 3 * kMaxElements) fail("too many faces");
        for (const Corner& corner : face_) {
            vertices_.note(corner.vertex, line_);
            texture_points_.note(corner.texture, line_);
            has_texture_ = has_texture_ && corner.texture >= 0;
            mesh_.corners.push_back(corner.vertex);
            if (has_texture_) mesh_.texture_corners.push_back(corner.texture);
        }
        mesh_.face_begin.push_back(mesh_.corners.size());
        face_lines_.push_back(line_);
    }

    static std::string_view trimmed(std::string_view name) {
        while (!name.empty() && is_space(name.front())) name.remove_prefix(1);
        return name;
    }

    void start_group(std::string_view name) {
        end_part();
        group_ = trimmed(name);
    }

    void start_object(std::string_view name) {
        end_part();
        object_ = trimmed(name);
        group_.clear();
    }

    void end_part() {
        const std::size_t count = mesh_.face_count() - part_begin_;
        if (count > 0) mesh_.parts.push_back({object_, group_, part_begin_, count});
        part_begin_ = mesh_.face_count();
    }

    void finish() {
        end_part();
        if (mesh_.positions.empty()) throw UserError(path_ + ": has no vertices ('v' lines)");
        if (mesh_.face_count() == 0) throw UserError(path_ + ": has no faces ('f' lines)");
        // A face may come before its vertices, so only now is it known what is out of range.
        if (vertices_.index >= static_cast<int>(mesh_.positions.size())) {
            line_ = vertices_.line;
            fail(
                fmt::format("vertex index {} is out of range: the file has {} vertices, counted "
                            "from 1",
                            vertices_.index + 1, mesh_.positions.size()));
        }
        check_texture();
        if (unknown_lines_ > 0) {
            warnings_.push_back(fmt::format("{}: {} lines with unknown keywords passed over", path_,
                                            unknown_lines_));
        }
    }

    /// The highest index that a face has named, and where.
    struct Highest {
        int index = -1;
        std::size_t line = 0;
        void note(int other, std::size_t at) {
            if (other > index) *this = {other, at};
        }
    };

    /// Texture coordinates are used where every corner has some.
    void check_texture() {
        if (texture_points_.index >= static_cast<int>(mesh_.texture.size())) {
            bad_texture_.note(0, texture_points_.line);
        }
        if (bad_texture_.index >= 0 && !mesh_.texture.empty()) {
            warnings_.push_back(
                fmt::format("{}:{}: texture coordinates that are not there, or no numbers; "
                            "all of them are passed over",
                            path_, bad_texture_.line));
        }
        if (!has_texture_ || bad_texture_.index >= 0) mesh_.texture_corners.clear();
    }

    static constexpr std::int64_t kMaxIndex = kMaxElements;

    const std::string& path_;
    Warnings& warnings_;
    PolygonMesh mesh_;
    std::vector<std::size_t> face_lines_;
    std::vector<Corner> face_;  ///< of the line that is read
    std::vector<int> sorted_;
    std::size_t line_ = 0;
    std::size_t unknown_lines_ = 0;
    std::string object_, group_;
    std::size_t part_begin_ = 0;
    Highest vertices_, texture_points_, bad_texture_;
    bool has_texture_ = true;  ///< all corners so far have a texture point
};

ObjFaces read_obj_faces(const std::string& path, Warnings& warnings) {
    require_obj(path);
    return parse_obj_faces(read_mesh_text(path, "an OBJ mesh"), path, warnings);
}

void require_same_faces(const ObjFaces& rest, const PolygonMesh& mesh) {
    const std::string& path = rest.mesh.source;
    if (rest.mesh.face_count() != mesh.face_count()) {
        throw UserError(
            fmt::format("{}: has {} faces, {} has {}: a rest shape has the same faces "
                        "in the same order",
                        path, rest.mesh.face_count(), mesh.source, mesh.face_count()));
    }
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        if (rest.mesh.face(f).size() == mesh.face(f).size()) continue;
        throw UserError(
            fmt::format("{}:{}: face {} has {} corners, in {} it has {}: a rest shape "
                        "has the same faces in the same order",
                        path, rest.lines[f], f + 1, rest.mesh.face(f).size(), mesh.source,
                        mesh.face(f).size()));
    }
}

}  // namespace

ObjFaces parse_obj_faces(std::string_view text, const std::string& path, Warnings& warnings) {
    return ObjParser(path, warnings).parse(text);
}

TriangleMesh parse_obj(std::string_view text, const std::string& path, Warnings& warnings) {
    const ObjFaces faces = parse_obj_faces(text, path, warnings);
    return triangles_of(faces.mesh, split_faces(faces.mesh, faces.lines));
}

TriangleMesh read_obj(const std::string& path, Warnings& warnings) {
    const ObjFaces faces = read_obj_faces(path, warnings);
    return triangles_of(faces.mesh, split_faces(faces.mesh, faces.lines));
}

TriangleMesh read_obj_with_rest(const std::string& path, const std::string& rest_path,
                                Warnings& warnings) {
    const ObjFaces faces = read_obj_faces(path, warnings);
    const ObjFaces rest = read_obj_faces(rest_path, warnings);
    require_same_faces(rest, faces.mesh);
    const FaceSplit split = split_faces(faces.mesh, faces.lines);
    TriangleMesh mesh = triangles_of(faces.mesh, split);
    mesh.rest_source = rest_path;
    mesh.rest.reserve(split.triangles.size());
    for (const auto& [a, b, c] : split.triangles) {
        const auto at = [&](std::size_t corner) {
            return rest.mesh.positions[static_cast<std::size_t>(rest.mesh.corners[corner])];
        };
        mesh.rest.push_back({at(a), at(b), at(c)});
    }
    return mesh;
}

}  // namespace weft
