#include "simulation/mesh/tet_reader.h"

#include <gtest/gtest.h>

#include <fstream>

#include "runtime/error.h"
#include "tests/simulation/mesh/tet_texts.h"

namespace weft {
namespace {

template <class Parse>
std::string message_of(Parse parse, const std::string& text, const char* path) {
    try {
        parse(text, path);
    } catch (const UserError& error) {
        return error.what();
    }
    return "no error";
}
std::string msh_message(const std::string& text) { return message_of(parse_msh, text, "m.msh"); }
std::string vtk_message(const std::string& text) { return message_of(parse_vtk, text, "m.vtk"); }

/// The mesh that all of tet_texts.h describe.
void expect_two_tetrahedra(const TetMesh& mesh) {
    ASSERT_EQ(mesh.vertex_count(), 5);
    EXPECT_EQ(mesh.positions[1], (Vec3{1.0, 0.0, 0.0}));
    EXPECT_EQ(mesh.positions[4], (Vec3{1.0, 1.0, 1.5}));
    EXPECT_EQ(mesh.tetrahedra, (std::vector<std::array<int, 4>>{{0, 1, 2, 3}, {1, 2, 3, 4}}));
}

TEST(TetReader, ReadsAllFormatsAlike) {
    for (const std::string& text : {test::kMsh2, test::kMsh4}) {
        expect_two_tetrahedra(parse_msh(text, "m.msh"));
    }
    for (const std::string& text : {test::kVtk2, test::kVtk5}) {
        expect_two_tetrahedra(parse_vtk(text, "m.vtk"));
    }
}

TEST(TetReader, GoesByTheEndingOfTheName) {
    const std::string path = testing::TempDir() + "weft_tet_reader.VTK";
    std::ofstream(path) << test::kVtk5;
    expect_two_tetrahedra(read_tetrahedra(path));
    std::remove(path.c_str());
    const auto read = [](const std::string& name) {
        return message_of([](const std::string& p, const char*) { read_tetrahedra(p); }, name, "");
    };
    EXPECT_EQ(read("no/such.msh"), "no/such.msh: no such mesh file");
    EXPECT_EQ(read("shirt.obj"),
              "shirt.obj: OBJ is not read here: a solid's mesh must be a Gmsh (.msh) or legacy VTK "
              "(.vtk) file");
    const std::string empty = testing::TempDir() + "weft_empty.msh";
    std::ofstream(empty) << "";
    EXPECT_EQ(read(empty), empty + ": is empty, expected a Gmsh mesh");
    std::remove(empty.c_str());
}

struct Mistake {
    const char* name;
    const std::string& text;
    const char* from;
    const char* to;
    const char* message;
};

void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

const Mistake kMistakes[] = {
    {"MshNoFormat", test::kMsh2, "$MeshFormat", "$Mesh", "m.msh:1: is not a Gmsh file"},
    {"MshBinary", test::kMsh2, "2.2 0 8", "2.2 1 8", "m.msh:2: is a binary Gmsh file"},
    {"MshVersion", test::kMsh4, "4.1 0 8", "4 0 8", "supported are 2.2 and 4.1"},
    {"MshNan", test::kMsh2, "1 1 1.5", "1 nan 1.5", "coordinate y = nan: must be finite"},
    {"MshHuge", test::kMsh4, "1 1 1.5", "1 1 1e30",
     "coordinate z = 1e+30: must be finite and within"},
    {"MshWord", test::kMsh2, "1 1 1.5", "1 one 1.5", "'one': expected coordinate y, a number"},
    {"MshIndex", test::kMsh2, "20 30 40 50", "20 30 40 99",
     "m.msh:16: node 99 is out of range: the file has 5 nodes, none of this number"},
    {"MshIndex4", test::kMsh4, "12 20 30 40 50", "12 20 30 40 -1", "node -1 is out of range"},
    {"MshTwice", test::kMsh2, "10 20 30 40\n", "10 20 30 30\n",
     "m.msh:15: degenerate tetrahedron 10 20 30 30: a vertex is named twice"},
    {"MshNodeTwice", test::kMsh2, "50 1 1 1.5", "40 1 1 1.5", "node 40 comes a second time"},
    {"MshHexahedra", test::kMsh4, "3 1 4 2", "3 1 5 2", "element 11 has type 5: only tetrahedra"},
    {"MshCutInNodes", test::kMsh2, "1.5\n$EndNodes", "", "expected"},
    {"MshTooMany", test::kMsh2, "$Nodes\n5", "$Nodes\n5000000",
     "the number of nodes = 5000000: the file is too short for so many"},
    {"MshNegative", test::kMsh4, "3 1 0 4", "3 1 0 -4", "must not be negative"},
    {"MshFewerNodes", test::kMsh2, "$Nodes\n5", "$Nodes\n4", "m.msh:10: '50': expected $EndNodes"},
    {"MshMoreNodes", test::kMsh2, "$Nodes\n5", "$Nodes\n6",
     "m.msh:11: '$EndNodes': expected a node's number"},
    {"MshFewerElements", test::kMsh2, "$Elements\n3", "$Elements\n2",
     "m.msh:16: '3': expected $EndElements"},
    {"MshMoreElements", test::kMsh2, "$Elements\n3", "$Elements\n4",
     "m.msh:17: '$EndElements': expected an element's number"},
    {"MshFewerNodesInAll", test::kMsh4, "2 5 10 50", "2 4 10 50",
     "m.msh:14: $Nodes promised 4 nodes in all, and its blocks have at least 5"},
    {"MshMoreNodesInAll", test::kMsh4, "2 5 10 50", "2 6 10 50",
     "m.msh:22: $Nodes promised 6 nodes in all, and its blocks have 5"},
    {"MshFewerElementsInAll", test::kMsh4, "2 3 1 12", "2 2 1 12",
     "m.msh:28: $Elements promised 2 elements in all, and its blocks have at least 3"},
    {"MshMoreElementsInAll", test::kMsh4, "2 3 1 12", "2 4 1 12",
     "m.msh:30: $Elements promised 4 elements in all, and its blocks have 3"},
    {"MshMissingEnd", test::kMsh2, "$EndElements\n", "",
     "the file ends here, expected $EndElements"},
    {"VtkNoHead", test::kVtk2, "# vtk DataFile", "# DataFile", "m.vtk:1: is not a legacy VTK file"},
    {"VtkBinary", test::kVtk2, "ASCII", "BINARY", "is a binary VTK file, which is not supported"},
    {"VtkSurface", test::kVtk2, "UNSTRUCTURED_GRID", "POLYDATA",
     "a solid needs an UNSTRUCTURED_GRID"},
    {"VtkNan", test::kVtk2, "1 1 1.5", "1 inf 1.5", "coordinate y = inf: must be finite"},
    {"VtkIndex", test::kVtk2, "4 1 2 3 4", "4 1 2 3 5",
     "cell 2 (from 0): point 5 is out of range: the file has 5 points, counted from 0"},
    {"VtkNegativeIndex", test::kVtk5, "0 1 2 3 1 2 3 4", "0 1 2 -3 1 2 3 4", "point -3 is out of"},
    {"VtkTwice", test::kVtk2, "4 1 2 3 4", "4 1 2 3 1", "degenerate tetrahedron 1 2 3 1"},
    {"VtkHexahedra", test::kVtk2, "\n10\n", "\n12\n",
     "cell 1 (from 0) has type 12: only tetrahedra"},
    {"VtkFivePoints", test::kVtk2, "14\n3 0 1 2\n4 0 1 2 3\n4 1 2 3 4",
     "13\n3 0 1 2\n4 0 1 2 3\n3 1 2 3", "is a tetrahedron of 3 points"},
    {"VtkOffsets", test::kVtk5, "0 3 7 11", "0 3 2 11", "offset 2: offsets must rise from 0 to 11"},
    {"VtkOffsetsBeyond", test::kVtk5, "0 3 7 11", "0 3 7 12", "offset 12: offsets must rise"},
    {"VtkFewerPoints", test::kVtk2, "POINTS 5", "POINTS 4", "m.vtk:10: '1': expected POINTS"},
    {"VtkMorePoints", test::kVtk2, "POINTS 5", "POINTS 6",
     "m.vtk:11: 'CELLS': expected coordinate x, a number"},
    {"VtkFewerCells", test::kVtk2, "CELLS 3 14", "CELLS 2 14",
     "m.vtk:13: CELLS promised 14 numbers in all, and there are 9"},
    {"VtkMoreCells", test::kVtk2, "CELLS 3 14", "CELLS 4 14",
     "m.vtk:15: 'CELL_TYPES': expected a cell's number of points"},
    {"VtkFewerNumbers", test::kVtk2, "CELLS 3 14", "CELLS 3 13",
     "m.vtk:14: a cell of 4 points: CELLS promised 13 numbers in all"},
    {"VtkMoreNumbers", test::kVtk2, "CELLS 3 14", "CELLS 3 15",
     "m.vtk:14: CELLS promised 15 numbers in all, and there are 14"},
    {"VtkMoreTypesThanPromised", test::kVtk2, "10\n10\nCELL", "10\n10\n10\nCELL",
     "m.vtk:19: '10': CELL_TYPES promised 3 types"},
    {"VtkLastOffset", test::kVtk5, "CELLS 4 11", "CELLS 4 12",
     "the last offset is 11: it must be 12"},
    {"VtkTypesMissing", test::kVtk2, "CELL_TYPES 3\n5\n10\n10\n", "",
     "'CELL_DATA': expected POINTS, CELLS or CELL_TYPES"},
    {"VtkTypesTooFew", test::kVtk2, "CELL_TYPES 3\n5\n10\n10\n", "CELL_TYPES 2\n5\n10\n",
     "2 cell types for 3 cells"},
    {"VtkTooMany", test::kVtk2, "POINTS 5", "POINTS 500", "the file is too short for so many"},
    {"VtkKeyword", test::kVtk2, "POINTS", "POINTZ",
     "'POINTZ': expected POINTS, CELLS or CELL_TYPES"},
};

class TetMistake : public testing::TestWithParam<Mistake> {};

TEST_P(TetMistake, IsExplained) {
    const Mistake& mistake = GetParam();
    std::string text = mistake.text;
    const std::size_t at = text.find(mistake.from);
    ASSERT_NE(at, std::string::npos);
    text.replace(at, std::string(mistake.from).size(), mistake.to);
    const bool is_msh = mistake.name[0] == 'M';
    const std::string message = is_msh ? msh_message(text) : vtk_message(text);
    EXPECT_NE(message.find(mistake.message), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(All, TetMistake, testing::ValuesIn(kMistakes),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(TetReader, EveryCutOffFileIsRefused) {
    for (const std::string* text : {&test::kMsh2, &test::kMsh4, &test::kVtk2, &test::kVtk5}) {
        const bool is_msh = text->front() == '$';
        // What follows the cells of a VTK file is not read.
        const std::size_t last = text->substr(0, text->find("CELL_DATA")).find_last_not_of(" \n");
        for (std::size_t length = 0; length < last; ++length) {
            const std::string cut = text->substr(0, length);
            const std::string message = is_msh ? msh_message(cut) : vtk_message(cut);
            EXPECT_NE(message, "no error") << cut;
        }
    }
}

TEST(TetReader, NoTetrahedraIsRefused) {
    EXPECT_EQ(
        vtk_message("# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\n"
                    "POINTS 3 float\n0 0 0 1 0 0 0 1 0\nCELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\n"),
        "m.vtk: has no tetrahedra; a solid needs a volume mesh, not only its surface");
    EXPECT_EQ(
        msh_message("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n0\n$EndNodes\n$Elements\n0\n"
                    "$EndElements\n"),
        "m.msh: has no vertices");
}

}  // namespace
}  // namespace weft
