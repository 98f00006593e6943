#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "apps/weft/run/run_options.h"
#include "apps/weft/studies/error_study.h"
#include "apps/weft/studies/stability/stability_study.h"

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

/// Those of `weft error`, which error_command.cpp adds.
void add_error_options(CLI::App& command, ErrorOptions& options);

/// Those of `weft stability`, which stability_command.cpp adds.
void add_stability_options(CLI::App& command, stability::StudyOptions& options);

/// Accepts one of `choices`; otherwise suggests the nearest.
CLI::Validator one_of(std::vector<std::string> choices);

/// Accepts a finite number above 0, or of 0 and more.
CLI::Validator above_zero();
CLI::Validator zero_or_more();

/// Accepts what can be a file's or folder's name; not the option behind an empty one.
CLI::Validator path_name();

/// The message and the near miss for a command line that CLI11 refused; one line.
std::string describe_parse_error(const CLI::App& app, const CLI::ParseError& error);

}  // namespace weft
