// Gmsh's MSH files: gmsh.info/doc/texinfo/gmsh.html, "MSH file format", versions 2 and 4.1.
#include <algorithm>
#include <unordered_map>

#include <fmt/format.h>

#include "runtime/error.h"
#include "simulation/mesh/tet_builder.h"
#include "simulation/mesh/tet_reader.h"

namespace weft {
namespace {

constexpr std::int64_t kMshTetrahedron = 4;

CellKind kind_of(std::int64_t type) {
    if (type == kMshTetrahedron) return CellKind::kTetrahedron;
    // Points, lines, triangles and quadrangles, also of higher order.
    const bool is_flat = (type >= 1 && type <= 3) || (type >= 8 && type <= 10) ||
                         (type >= 15 && type <= 16) || (type >= 20 && type <= 28);
    return is_flat ? CellKind::kFlat : CellKind::kOtherSolid;
}

class MshParser {
public:
    MshParser(std::string_view text, const std::string& path)
        : words_(text, path), builder_(path) {}

    TetMesh parse() {
        parse_format();
        bool has_elements = false;
        while (!words_.at_end()) {
            const std::string section(words_.word("a section"));
            if (!section.starts_with('$')) {
                words_.fail(fmt::format("{}: expected a section ($Nodes, $Elements, ...)",
                                        quoted(section)));
            }
            if (section == "$Nodes") {
                if (is_version_4_)
                    parse_nodes_4();
                else
                    parse_nodes_2();
            } else if (section == "$Elements") {
                if (is_version_4_)
                    parse_elements_4();
                else
                    parse_elements_2();
                has_elements = true;
            } else {
                skip_section(section);
                continue;
            }
            expect_end(section);
        }
        if (!has_elements) words_.fail("the file ends here, expected $Elements");
        return builder_.finish();
    }

private:
    void parse_format() {
        if (words_.word("$MeshFormat") != "$MeshFormat") {
            words_.fail("is not a Gmsh file: it must begin with $MeshFormat");
        }
        const std::string version(words_.word("the format's version"));
        const std::int64_t is_binary = words_.integer("the file type");
        if (is_binary != 0) {
            words_.fail(
                "is a binary Gmsh file, which is not supported; save it as ASCII "
                "(gmsh -format msh41, without -bin)");
        }
        is_version_4_ = version == "4.1";
        if (!is_version_4_ && version != "2" && !version.starts_with("2.")) {
            words_.fail(
                fmt::format("format version {}: supported are 2.2 and 4.1 (gmsh -format msh41)",
                            quoted(version)));
        }
        words_.integer("the size of numbers");
        expect_end("$MeshFormat");
    }

    void expect_end(const std::string& section) {
        const std::string end = "$End" + section.substr(1);
        const std::string_view word = words_.word(end);
        if (word != end) words_.fail(fmt::format("{}: expected {}", quoted(word), end));
    }

    void skip_section(const std::string& section) {
        const std::string end = "$End" + section.substr(1);
        while (words_.word(end) != end) words_.rest_of_line();
    }

    /// Of version 4.1, where a section says how many things it has, and each of its blocks, too.
    [[noreturn]] void fail_sum(const char* section, const char* things, std::size_t promised,
                               std::size_t found) const {
        words_.fail(fmt::format("{} promised {} {} in all, and its blocks {} {}", section, promised,
                                things, found > promised ? "have at least" : "have", found));
    }

    // --- nodes

    void add_node(std::int64_t tag, Vec3 position) {
        const bool is_new = vertex_.emplace(tag, builder_.mesh().vertex_count()).second;
        if (!is_new) words_.fail(fmt::format("node {} comes a second time", tag));
        builder_.add_vertex(position);
    }

    void parse_nodes_2() {
        const std::size_t count = words_.count("the number of nodes", 8);
        for (std::size_t i = 0; i < count; ++i) {
            const std::int64_t tag = words_.integer("a node's number");
            add_node(tag, words_.position());
        }
    }

    void parse_nodes_4() {
        const std::size_t blocks = words_.count("the number of blocks of nodes", 2);
        const std::size_t all = words_.count("the number of all nodes", 8);
        words_.rest_of_line();  // their lowest and highest tags
        std::size_t sum = 0;
        for (std::size_t block = 0; block < blocks; ++block) {
            words_.integer("the dimension of nodes");
            words_.integer("the entity of nodes");
            words_.integer("whether nodes have parameters");
            const std::size_t count = words_.count("the number of nodes", 8);
            sum += count;
            if (sum > all) fail_sum("$Nodes", "nodes", all, sum);
            std::vector<std::int64_t> tags;
            for (std::size_t i = 0; i < count; ++i) tags.push_back(words_.integer("a node's tag"));
            for (const std::int64_t tag : tags) {
                add_node(tag, words_.position());
                words_.rest_of_line();  // parameters
            }
        }
        if (sum < all) fail_sum("$Nodes", "nodes", all, sum);
    }

    // --- elements, of which each has a line

    /// The nodes of an element are the last words of its line.
    void parse_element(std::int64_t tag, std::int64_t type) {
        switch (kind_of(type)) {
            case CellKind::kTetrahedron:
                add_tetrahedron();
                break;
            case CellKind::kFlat:
                words_.rest_of_line();
                break;
            case CellKind::kOtherSolid:
                words_.fail(
                    fmt::format("element {} has type {}: only tetrahedra with 4 nodes (type 4) "
                                "are supported",
                                tag, type));
        }
    }

    void add_tetrahedron() {
        std::array<std::int64_t, 4> nodes{};
        std::array<int, 4> vertices{};
        for (std::size_t k = 0; k < 4; ++k) {
            nodes[k] = words_.integer("a node");
            const auto found = vertex_.find(nodes[k]);
            if (found == vertex_.end()) {
                words_.fail(
                    fmt::format("node {} is out of range: the file has {} nodes, none of this "
                                "number",
                                nodes[k], vertex_.size()));
            }
            vertices[k] = found->second;
        }
        builder_.add_tetrahedron(vertices, nodes, words_);
    }

    void parse_elements_2() {
        const std::size_t count = words_.count("the number of elements", 4);
        for (std::size_t i = 0; i < count; ++i) {
            const std::int64_t tag = words_.integer("an element's number");
            const std::int64_t type = words_.integer("an element's type");
            const std::size_t tags = words_.count("an element's number of tags", 2);
            for (std::size_t t = 0; t < tags; ++t) words_.integer("a tag");
            parse_element(tag, type);
        }
    }

    void parse_elements_4() {
        const std::size_t blocks = words_.count("the number of blocks of elements", 2);
        const std::size_t all = words_.count("the number of all elements", 4);
        words_.rest_of_line();  // their lowest and highest tags
        std::size_t sum = 0;
        for (std::size_t block = 0; block < blocks; ++block) {
            words_.integer("the dimension of elements");
            words_.integer("the entity of elements");
            const std::int64_t type = words_.integer("the elements' type");
            const std::size_t count = words_.count("the number of elements", 4);
            sum += count;
            if (sum > all) fail_sum("$Elements", "elements", all, sum);
            for (std::size_t i = 0; i < count; ++i) {
                parse_element(words_.integer("an element's tag"), type);
            }
        }
        if (sum < all) fail_sum("$Elements", "elements", all, sum);
    }

    MeshWords words_;
    TetBuilder builder_;
    bool is_version_4_ = false;
    std::unordered_map<std::int64_t, int> vertex_;  ///< of each node's number
};

}  // namespace

TetMesh parse_msh(std::string_view text, const std::string& path) {
    return MshParser(text, path).parse();
}

}  // namespace weft
