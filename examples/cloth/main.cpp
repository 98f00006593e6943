// A sheet that hangs by two corners, is pushed, and read after every frame:  cloth [DEVICES]
#include <weft/cloth.h>

#include <cstdio>

namespace {

constexpr const char* kScene = R"(
    [scene]
    frames = 60
    dt = 0.02
    substeps = 8
    [solver]
    method = "xpbd"
    iterations = 8
    [[cloth]]
    name = "sheet"
    grid = { size = [1.0, 1.0], resolution = [24, 24] }
    density = 0.2
    stretch = { stiffness = 1.0e4 }
    bend = { stiffness = 1.0e-4 }
    damping = 0.5
    pins = { corners = ["x-z-", "x+z-"] }
)";

/// The mean of all vertices along an axis.
double mean(const std::vector<float>& xyz, std::size_t axis) {
    double sum = 0.0;
    for (std::size_t i = axis; i < xyz.size(); i += 3) sum += xyz[i];
    return sum / static_cast<double>(xyz.size() / 3);
}

}  // namespace

int main(int count, char** arguments) {
    const weft::ClothOptions options{.devices = count > 1 ? arguments[1] : "hybrid"};
    weft::ClothScene pushed = weft::ClothScene::from_text(kScene, "sheet.toml", options);
    weft::ClothScene left_alone = weft::ClothScene::from_text(kScene, "sheet.toml", options);
    for (const std::string& warning : pushed.warnings()) std::printf("%s\n", warning.c_str());
    const weft::ClothBody sheet = pushed.bodies().front();
    std::printf("%s: %d vertices, %zu triangles\n", sheet.name.c_str(), sheet.count,
                pushed.triangles().size());

    while (pushed.frame() < 19) {
        if (pushed.frame() == 15)
            pushed.push(sheet.first, sheet.count, {4.0f, 0.0f, 0.0f});  // [m/s]
        pushed.step();
        left_alone.step();
    }
    const double moved = mean(pushed.positions(), 0) - mean(left_alone.positions(), 0);
    std::printf("after %.2f s the push has made %.3f m of difference; state %s\n", pushed.time(),
                moved, pushed.state_hash().c_str());
    return moved > 0.1 ? 0 : 1;
}
