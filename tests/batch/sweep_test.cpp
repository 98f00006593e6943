#include "apps/weft/batch/sweep.h"

#include <cmath>

#include "apps/weft/batch/axis.h"
#include "sweep_text.h"

namespace weft::batch {
namespace {

/// "1 a, 1 b, ..." of the axes' values alone.
std::string shown(const std::vector<Point>& points) {
    std::string text;
    for (const Point& point : points) {
        text += text.empty() ? "" : ", ";
        for (std::size_t i = 0; i < point.size(); ++i) {
            text += (i > 0 ? " " : "") + to_text(point[i].value);
        }
    }
    return text;
}

std::string expanded(const std::string& text) {
    return shown(points_of(parse_sweep(kHead + text, "s.toml")));
}

std::string refused(const std::string& text) {
    return message_of([&] { points_of(parse_sweep(kHead + text, "s.toml")); });
}

TEST(Sweep, IsTheProductWithTheLastAxisFastest) {
    EXPECT_EQ(expanded(R"(
[[axis]]
key = "solver.method"
values = ["xpbd", "vbd"]
[[axis]]
key = "scene.substeps"
values = [1, 2, 4]
)"),
              "xpbd 1, xpbd 2, xpbd 4, vbd 1, vbd 2, vbd 4");
}

TEST(Sweep, KeysOfOneAxisChangeTogether) {
    EXPECT_EQ(expanded(R"(
[[axis]]
keys = ["scene.substeps", "solver.iterations"]
values = [[2, 32], [8, 8]]
)"),
              "2 32, 8 8");
}

TEST(Sweep, LeavesOutPointsThatHaveAllOfIt) {
    EXPECT_EQ(expanded(R"(
[[axis]]
key = "a.b"
values = ["x", "y"]
[[axis]]
key = "c.d"
values = [1, 2]
[[leave_out]]
"a.b" = "y"
"c.d" = 2.0
)"),
              "x 1, x 2, y 1");
}

TEST(Sweep, RangesMeetTheirEnds) {
    const auto numbers = [](const std::string& range) {
        const auto points = points_of(
            parse_sweep(kHead + "[[axis]]\nkey = \"a.b\"\nrange = " + range + "\n", "s.toml"));
        std::vector<double> list;
        for (const Point& point : points) list.push_back(point.front().value.get<double>());
        return list;
    };
    const auto logarithmic = numbers("{ from = 1e3, to = 1e6, count = 4, scale = \"log\" }");
    ASSERT_EQ(logarithmic.size(), 4U);
    EXPECT_EQ(logarithmic.front(), 1e3);
    EXPECT_EQ(logarithmic.back(), 1e6);
    // What a person would write, so that it can be selected: std::pow alone gives
    // 9999.999999999998.
    EXPECT_EQ(logarithmic, (std::vector<double>{1e3, 1e4, 1e5, 1e6}));
    EXPECT_EQ(numbers("{ from = 1e2, to = 1e5, count = 4, scale = \"log\" }"),
              (std::vector<double>{1e2, 1e3, 1e4, 1e5}));
    EXPECT_EQ(numbers("{ from = 0.1, to = 0.5, count = 5 }"),
              (std::vector<double>{0.1, 0.2, 0.3, 0.4, 0.5}));
    EXPECT_EQ(numbers("{ from = -0.3, to = 0.6, count = 4 }"),
              (std::vector<double>{-0.3, 0.0, 0.3, 0.6}));
    const auto exact = numbers("{ from = 0.12345678901234567, to = 1e30, count = 2 }");
    EXPECT_EQ(exact.front(), 0.12345678901234567);
    EXPECT_EQ(numbers("{ from = 1.0, to = 0.0, count = 3 }"), (std::vector<double>{1.0, 0.5, 0.0}));
}

TEST(Sweep, RangesOfWholeNumbersStayWhole) {
    const auto text = [](const char* range) {
        return expanded(std::string("[[axis]]\nkey = \"a.b\"\nrange = ") + range + "\n");
    };
    EXPECT_EQ(text("{ from = 1, to = 8, count = 4, scale = \"log\" }"), "1, 2, 4, 8");
    EXPECT_EQ(text("{ from = 2, to = 8, count = 3 }"), "2, 5, 8");
    EXPECT_EQ(text("{ from = 1, to = 2, count = 3 }"), "1.0, 1.5, 2.0");
}

TEST(Sweep, LeavingOutNothingIsAMistake) {
    const std::string axes = R"(
[[axis]]
key = "a.b"
values = ["x", "y"]
[[axis]]
keys = ["c.d", "e.f"]
values = [[1, 2], [3, 4]]
)";
    const std::string wrong =
        refused(axes + "[[leave_out]]\n\"a.b\" = \"x\"\n[[leave_out]]\n\"c.d\" = 2\n");
    EXPECT_NE(wrong.find("s.toml:12:1: [[leave_out]] c.d = 2: no run"), std::string::npos) << wrong;
    // Each value is there, but no run has both.
    EXPECT_NE(refused(axes + "[[leave_out]]\n\"c.d\" = 1\n\"e.f\" = 4\n").find("no run"),
              std::string::npos);
    const std::string dotted = refused(axes + "[[leave_out]]\na.b = \"x\"\n");
    EXPECT_NE(dotted.find("stand in quotes"), std::string::npos) << dotted;
    // What another one leaves out already may be left out again.
    EXPECT_EQ(expanded(axes + "[[leave_out]]\n\"a.b\" = \"x\"\n"
                              "[[leave_out]]\n\"a.b\" = \"x\"\n\"c.d\" = 1\n"),
              "y 1 2, y 3 4");
}

TEST(Sweep, SaysWhereItIsWrong) {
    const std::string axis = "[[axis]]\nkey = \"a.b\"\n";
    EXPECT_NE(refused("[[axes]]\nkey = \"a\"\n").find("unknown key 'axes'"), std::string::npos);
    EXPECT_NE(refused(axis).find("exactly one of"), std::string::npos);
    EXPECT_NE(refused(axis + "values = []\n").find("expected a list"), std::string::npos);
    EXPECT_NE(refused("[[axis]]\nkeys = [\"a\", \"b\"]\nvalues = [[1]]\n").find("2 values"),
              std::string::npos);
    EXPECT_NE(refused(axis + "range = { from = -1, to = 2, count = 3, scale = \"log\" }\n")
                  .find("positive"),
              std::string::npos);
    EXPECT_NE(refused(axis + "range = { from = 1, to = 2, count = 1 }\n").find("from 2 to"),
              std::string::npos);
    EXPECT_NE(refused(axis + "range = { from = 1, to = 2, count = 1000000000 }\n")
                  .find("from 2 to 1000000"),
              std::string::npos);
    EXPECT_NE(refused(axis + "values = [1]\n" + axis + "values = [2]\n").find("already"),
              std::string::npos);
    EXPECT_NE(refused(axis + "values = [1]\n[[leave_out]]\n\"a.c\" = 1\n").find("'a.b'"),
              std::string::npos);
    EXPECT_NE(refused(axis + "values = [1]\n[[leave_out]]\n\"a.b\" = 1\n").find("no run"),
              std::string::npos);
    EXPECT_NE(refused(axis + "values = [inf]\n").find("finite"), std::string::npos);
    EXPECT_NE(message_of([] {
                  parse_sweep("sweep = { name = \"../x\", scene = \"a\" }", "s.toml");
              }).find("folder"),
              std::string::npos);
}

class SweepTable : public InFolder {};

TEST_F(SweepTable, PointsOfASampler) {
    write("points.csv", "solver.method, \"cloth[0].density\"\nxpbd,0.25\n\n\"vbd\", 1e-1\n");
    const std::string path = write("s.toml", kHead + "[[axis]]\ntable = \"points.csv\"\n");
    const auto points = points_of(read_sweep(path));
    EXPECT_EQ(shown(points), "xpbd 0.25, vbd 0.1");
    EXPECT_EQ(points[0][1].key, "cloth[0].density");
}

TEST_F(SweepTable, LinesMustBeWhole) {
    write("points.csv", "a.b,c.d\n1,2\n3\n");
    const std::string path = write("s.toml", kHead + "[[axis]]\ntable = \"points.csv\"\n");
    EXPECT_NE(message_of([&] { read_sweep(path); }).find("points.csv: row 2: 1 values"),
              std::string::npos);
}

TEST(Csv, MayBeginWithAByteOrderMark) {
    EXPECT_EQ(parse_csv("\xEF\xBB\xBFscene.frames\n1\n")[0][0], "scene.frames");
}

TEST(Csv, QuotedCellsHoldAnything) {
    const auto lines = parse_csv("a,\"b,\"\"c\"\"\nd\"\r\n,\n");
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_EQ(lines[0], (std::vector<std::string>{"a", "b,\"c\"\nd"}));
    EXPECT_EQ(lines[1], (std::vector<std::string>{"", ""}));
}

TEST(Duration, IsReadWithUnits) {
    EXPECT_EQ(parse_duration("1h30m", "t"), 5400.0);
    EXPECT_EQ(parse_duration("90s", "t"), 90.0);
    EXPECT_EQ(parse_duration(12, "t"), 12.0);
    for (const Value& wrong : {Value("20"), Value("m"), Value("0s"), Value(-1), Value(true)}) {
        EXPECT_THROW(parse_duration(wrong, "t"), UserError) << wrong;
    }
}

TEST(TomlText, IsReadBack) {
    const Value value = Value::parse(R"({"a b": [1, 2.5, "x\"y\n", true], "c": 1e-7})");
    EXPECT_EQ(to_json(parse_toml_value(to_toml(value), "test")), value);
}

}  // namespace
}  // namespace weft::batch
