#pragma once

namespace CLI {
class App;
}

/// Every subcommand of weft, one file each (<name>_command.cpp). A function adds its subcommand,
/// with its options, its help with an example, and a callback that does the work. It throws
/// UserError or RunError; program.cpp turns these into messages and exit codes.
namespace weft {

void add_batch_command(CLI::App& app);
void add_compare_command(CLI::App& app);
void add_devices_command(CLI::App& app);
void add_error_command(CLI::App& app);
void add_inspect_command(CLI::App& app);
void add_plan_command(CLI::App& app);
void add_replay_command(CLI::App& app);
void add_run_command(CLI::App& app);
void add_stability_command(CLI::App& app);
void add_trace_command(CLI::App& app);

// Of `weft trace`.
void add_gantt_command(CLI::App& trace);
void add_perfetto_command(CLI::App& trace);

}  // namespace weft
