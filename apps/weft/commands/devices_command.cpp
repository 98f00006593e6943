#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/weft/command_line/common_options.h"
#include "apps/weft/commands/commands.h"
#include "apps/weft/timing/device_costs.h"
#include "runtime/device_list.h"
#include "runtime/error.h"
#include "runtime/io/json_text.h"
#include "runtime/opencl/opencl_device.h"

namespace weft {

namespace {

/// One device of the machine, or why it cannot be used.
struct Row {
    std::string device;  ///< as --device takes it
    DeviceInfo info;
    DeviceCosts costs;
    std::string error;
};

Row examine(const std::string& name, const DeviceOptions& options) {
    Row row;
    row.device = name;
    try {
        const auto opened = open_devices(name, options);
        row.info = opened.front()->info();
        row.costs = measure_costs(*opened.front());
    } catch (const std::exception& error) {
        row.error = error.what();  // one broken driver must not hide the other devices
    }
    return row;
}

nlohmann::ordered_json transfer_json(const std::optional<TransferCost>& cost) {
    if (!cost) return nullptr;
    return {{"latency_us", 1e6 * cost->latency}, {"gb_per_s", 1e-9 * cost->bandwidth}};
}

nlohmann::ordered_json row_json(const Row& row) {
    nlohmann::ordered_json json{{"device", row.device}};
    if (!row.error.empty()) {
        json["error"] = row.error;
        return json;
    }
    json["name"] = row.info.name;
    json["kind"] = row.info.kind;
    json["driver"] = row.info.driver;
    json["units"] = row.info.units;
    json["memory"] = name_of(row.info.memory);
    json["strict"] = row.info.strict;
    json["lanes"] = row.info.lanes;
    json["batch_us"] = 1e6 * row.costs.batch;
    json["launch_us"] = 1e6 * row.costs.launch;
    json["to_device"] = transfer_json(row.costs.to_device);
    json["to_host"] = transfer_json(row.costs.to_host);
    return json;
}

std::string transfer_text(const std::optional<TransferCost>& cost) {
    if (!cost) return "no copies";
    return fmt::format("{:.1f} us + {:.1f} GB/s", 1e6 * cost->latency, 1e-9 * cost->bandwidth);
}

std::string row_text(const Row& row) {
    if (!row.error.empty())
        return fmt::format("{:<10} cannot be used: {}\n", row.device, row.error);
    const auto line = [](const char* what, const std::string& value) {
        return fmt::format("{:<10} {:<11} {}\n", "", what, value);
    };
    const DeviceInfo& info = row.info;
    std::string text = fmt::format("{:<10} {}\n", row.device, info.name);
    text += line("kind",
                 fmt::format("{}, {} unit{}, {} lane{}", info.kind, info.units,
                             info.units == 1 ? "" : "s", info.lanes, info.lanes == 1 ? "" : "s"));
    if (!info.driver.empty()) text += line("driver", info.driver);
    text += line("memory", std::string(name_of(info.memory)));
    text += line("arithmetic", info.strict ? "strict: the same bits as the other strict devices"
                                           : "does not round correctly: its last bits may differ");
    text += line("launch", fmt::format("{:.1f} us to submit one task and wait for it, {:.2f} us "
                                       "for each further one",
                                       1e6 * row.costs.batch, 1e6 * row.costs.launch));
    if (info.memory == MemoryModel::kHost) return text;
    return text + line("to device", transfer_text(row.costs.to_device)) +
           line("to host", transfer_text(row.costs.to_host));
}

struct DevicesOptions {
    RunOptions run;
    bool json = false;
};

void list_devices(const DevicesOptions& options) {
    const std::vector<std::string> names = available_devices();
    std::vector<Row> rows;
    for (const std::string& name : names) {
        rows.push_back(examine(name, options.run.simulation().device_options));
    }
    if (options.json) {
        nlohmann::ordered_json json;
        json["devices"] = nlohmann::ordered_json::array();
        for (const Row& row : rows) json["devices"].push_back(row_json(row));
        json["hybrid"] = hybrid_devices();
        std::cout << json_text(json) << '\n';
        return;
    }
    for (const Row& row : rows) std::cout << row_text(row) << '\n';
    std::cout << fmt::format("--device hybrid, the default, is {} here\n", hybrid_devices());
    for (const std::string& trouble : opencl_troubles()) std::cerr << "weft: " << trouble << '\n';
    if (names.size() > 1) return;
    std::cerr
        << "weft: no OpenCL device was found; pocl-opencl-icd makes one of the CPU, and a GPU "
           "needs its vendor's driver\n";
}

}  // namespace

void add_devices_command(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("devices", "List this machine's devices, and measure what they cost");
    const auto options = std::make_shared<DevicesOptions>();
    add_memory_option(*command, options->run);
    command->add_flag("--json", options->json, "print one JSON document");
    command->footer("Examples:\n  weft devices\n  weft devices --memory discrete --json");
    command->callback([options] { list_devices(*options); });
}

}  // namespace weft
