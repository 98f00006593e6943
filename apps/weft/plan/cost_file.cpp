#include "apps/weft/plan/cost_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/weft/plan/json_file.h"
#include "runtime/near_miss.h"

namespace weft {

namespace {

using json = JsonFile::Json;
using nlohmann::ordered_json;
using scheduler::LinearCost;

class CostReader {
public:
    CostReader(const std::string& path, const std::vector<std::string>& kinds)
        : json_(path), kinds_(kinds) {}

    MachineCosts read() const {
        const json& root = json_.root();
        if (!root.is_object()) json_.fail("expected one object {...} with devices and costs");
        json_.check_keys(root, {"devices", "costs", "latency", "bandwidth"}, "");
        MachineCosts costs(json_.names(json_.member(root, "devices", ""), "devices", "device"),
                           kinds_.size());
        read_kinds(json_.member(root, "costs", ""), costs);
        read_links_into(costs);
        return costs;
    }

private:
    void read_kinds(const json& object, MachineCosts& costs) const {
        json_.object(object, "costs", "one list per kind of task: {\"predict\": [...], ...}");
        for (const auto& [kind, value] : object.items()) {
            if (std::find(kinds_.begin(), kinds_.end(), kind) != kinds_.end()) continue;
            json_.fail("costs." + kind,
                       "the trace has no tasks of this kind; " + near_miss_or_list(kind, kinds_));
        }
        for (std::size_t k = 0; k < kinds_.size(); ++k) {
            const std::string field = "costs." + kinds_[k];
            const json& list = json_.array(json_.member(object, kinds_[k], "costs."), field,
                                           "a list with one cost or null per device");
            if (list.size() != costs.devices.size()) {
                json_.fail(field, fmt::format("{} costs for {} devices", list.size(),
                                              costs.devices.size()));
            }
            for (std::size_t d = 0; d < list.size(); ++d) {
                if (list[d].is_null()) continue;
                costs.kinds[k][d] = read_cost(list[d], fmt::format("{}[{}]", field, d));
            }
        }
    }

    LinearCost read_cost(const json& value, const std::string& field) const {
        json_.object(value, field, "{\"fixed\": ..., \"per_item\": ...} or null");
        json_.check_keys(value, {"fixed", "per_item"}, field + ".");
        const auto seconds = [&](const char* key) {
            return json_.number(json_.member(value, key, field + "."), field + "." + key,
                                "seconds >= 0");
        };
        return {seconds("fixed"), seconds("per_item")};
    }

    void read_links_into(MachineCosts& costs) const {
        const std::size_t count = costs.devices.size();
        const LinkValues links = read_links(json_, count, std::numeric_limits<double>::infinity());
        for (std::size_t from = 0; from < count; ++from) {
            for (std::size_t to = 0; to < count; ++to) {
                costs.latency[from][to] = links.latency[from * count + to];
                costs.bandwidth[from][to] = links.bandwidth[from * count + to];
            }
        }
    }

    JsonFile json_;
    const std::vector<std::string>& kinds_;
};

/// JSON has no infinity: null stands for it.
ordered_json rows_json(const std::vector<std::vector<double>>& rows, double diagonal) {
    ordered_json list = ordered_json::array();
    for (std::size_t from = 0; from < rows.size(); ++from) {
        ordered_json row = ordered_json::array();
        for (std::size_t to = 0; to < rows.size(); ++to) {
            const double value = from == to ? diagonal : rows[from][to];
            row.push_back(std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr));
        }
        list.push_back(std::move(row));
    }
    return list;
}

}  // namespace

MachineCosts read_cost_file(const std::string& path, const std::vector<std::string>& kinds) {
    return CostReader(path, kinds).read();
}

ordered_json to_json(const MachineCosts& costs, const std::vector<std::string>& kinds) {
    ordered_json json;
    json["devices"] = costs.devices;
    json["costs"] = ordered_json::object();
    for (std::size_t k = 0; k < kinds.size(); ++k) {
        ordered_json list = ordered_json::array();
        for (const auto& cost : costs.kinds[k]) {
            if (cost)
                list.push_back({{"fixed", cost->fixed}, {"per_item", cost->per_item}});
            else
                list.push_back(nullptr);
        }
        json["costs"][kinds[k]] = std::move(list);
    }
    if (costs.devices.size() < 2) return json;
    json["latency"] = rows_json(costs.latency, 0.0);
    json["bandwidth"] = rows_json(costs.bandwidth, std::numeric_limits<double>::infinity());
    return json;
}

}  // namespace weft
