#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "simulation/scene/read_scene.h"
#include "simulation/simulation.h"

namespace weft {

/// Options of `run`, most of which serve other commands too. `weft run --help` says what they mean.
struct RunOptions {
    std::string scene;
    std::string device = "hybrid";
    std::string plan = "auto";
    std::string math = "strict";
    std::string memory = "auto";
    std::vector<int> strips;  ///< per device; empty: planned
    // Values of the scene stay text: the scene's own check says what is wrong with them.
    std::optional<std::string> solver;
    std::optional<std::string> frames;
    std::optional<std::string> substeps;
    std::optional<std::string> iterations;
    std::vector<std::string> set;
    std::optional<std::string> out;
    bool no_geometry = false;
    bool no_trace = false;
    bool force = false;
    bool resume = false;
    double checkpoint = 10.0;  ///< [s] between two of them
    bool quiet = false;
    bool json = false;

    /// --set first, then the short forms, which win; for read_scene().
    std::vector<Override> overrides() const;
    /// Throws UserError for what this version does not have.
    SimulationOptions simulation() const;
};

/// SCENE and what changes it: --solver --frames --substeps --iterations --set.
/// `options` must outlive the parse.
void add_scene_options(CLI::App& command, RunOptions& options);

/// --device --plan --math --memory --strips.
void add_device_options(CLI::App& command, RunOptions& options);

/// --memory alone.
void add_memory_option(CLI::App& command, RunOptions& options);

/// --out --no-geometry --no-trace --force --resume.
void add_output_options(CLI::App& command, RunOptions& options);

/// --quiet --json.
void add_talk_options(CLI::App& command, RunOptions& options);

/// All four of the above, and --print-schema.
void add_run_options(CLI::App& command, RunOptions& options);

/// What the user typed, words joined by blanks; for traces. main() notes it.
void note_command_line(int argc, char** argv);
const std::string& command_line();

/// "weft: warning: ..." on stderr, each.
void print_warnings(const Warnings& warnings);

/// Accepts one of `choices`; otherwise suggests the nearest.
CLI::Validator one_of(std::vector<std::string> choices);

/// The message and the near miss for a command line that CLI11 refused; one line.
std::string describe_parse_error(const CLI::App& app, const CLI::ParseError& error);

}  // namespace weft
