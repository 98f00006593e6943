#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace weft {

struct ClothOptions {
    std::string devices = "hybrid";           ///< as open_devices() knows them
    std::filesystem::path cost_file = {};     ///< where costs are kept between runs; empty: nowhere
    std::vector<std::string> overrides = {};  ///< "scene.substeps=8", as `weft run --set`
};

/// A cloth or a solid of a scene: its vertices are [first, first + count).
struct ClothBody {
    std::string name;
    int first = 0;
    int count = 0;
};

/// A scene (docs/scenes.md), frame by frame, to be looked at and pushed between frames. All that is
/// asked for is in scene order: the vertices of the meshes, cloth by cloth, then solid by solid. SI
/// units, y up. The results do not depend on the devices.
class ClothScene {
public:
    /// Throws UserError for a file, scene or devices that cannot be had.
    explicit ClothScene(const std::filesystem::path& file, const ClothOptions& options = {});
    /// From a scene's text instead of a file; name is for messages.
    static ClothScene from_text(const std::string& text, const std::string& name = "scene.toml",
                                const ClothOptions& options = {});
    ~ClothScene();
    ClothScene(ClothScene&&) noexcept;

    /// Simulates the next frame. Throws RunError if the state goes bad or the last device is lost;
    /// the state is that of the frame's start then.
    void step();
    int frame() const;          ///< the next one
    int frame_count() const;    ///< that the scene asks for
    double time() const;        ///< simulated so far [s]
    double frame_time() const;  ///< of one frame [s]

    int vertex_count() const;
    std::vector<ClothBody> bodies() const;
    /// Of cloths all, of solids their surface. [triangles] three vertices each
    std::vector<std::array<int, 3>> triangles() const;

    /// [3 * vertex_count()] xyz [m]. A scene far from its origin is simulated as if it were near;
    /// these are as exact as single precision is there.
    std::vector<float> positions() const;
    std::vector<float> velocities() const;  ///< [3 * vertex_count()] xyz [m/s]
    /// Another state for the next frame to start from; sizes as above, Misuse otherwise. Pinned
    /// vertices are held where they are put.
    void set_state(std::span<const float> positions, std::span<const float> velocities);
    /// Gives vertices [first, first + count) a push: adds to their velocities [m/s].
    void push(int first, int count, const std::array<float, 3>& velocity);

    /// 32 hex digits over all bits of positions and velocities.
    std::string state_hash() const;
    /// What is worth knowing of the scene and the devices, so far.
    std::vector<std::string> warnings() const;

private:
    class Impl;
    explicit ClothScene(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace weft
