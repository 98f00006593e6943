#pragma once

#include <CLI/CLI.hpp>

#include "apps/weft/run/run_options.h"

namespace weft {

/// SCENE and what changes it: --solver --frames --substeps --iterations --set.
/// `options` must outlive the parse.
void add_scene_options(CLI::App& command, RunOptions& options);

/// --device --plan --math --memory --strips.
void add_device_options(CLI::App& command, RunOptions& options);

/// --memory alone.
void add_memory_option(CLI::App& command, RunOptions& options);

/// --out --no-geometry --no-trace --force --resume.
void add_output_options(CLI::App& command, RunOptions& options);

/// --on-trouble.
void add_trouble_option(CLI::App& command, RunOptions& options);

/// --on-crossing.
void add_crossing_option(CLI::App& command, RunOptions& options);

/// --quiet --json.
void add_talk_options(CLI::App& command, RunOptions& options);

/// All of the above, and --print-schema.
void add_run_options(CLI::App& command, RunOptions& options);

}  // namespace weft
