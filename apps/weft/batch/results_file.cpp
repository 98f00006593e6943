#include "apps/weft/batch/results_file.h"

#include <algorithm>
#include <limits>

#include "apps/weft/batch/drive.h"
#include "runtime/io/hdf5/attributes.h"
#include "runtime/io/hdf5/datasets.h"
#include "runtime/io/hdf5/files.h"
#include "runtime/io/hdf5_file.h"

namespace weft::batch {

namespace {

namespace fs = std::filesystem;

/// Numbers throughout become doubles, anything else text.
void write_column(hid_t group, const std::string& name, const std::vector<const Value*>& cells) {
    const bool numbers = std::ranges::all_of(
        cells, [](const Value* cell) { return cell->is_number() || cell->is_null(); });
    if (numbers) {
        std::vector<double> values;
        for (const Value* cell : cells) {
            values.push_back(cell->is_null() ? std::numeric_limits<double>::quiet_NaN()
                                             : cell->get<double>());
        }
        hdf5::write_numbers(group, name, values);
        return;
    }
    std::vector<std::string> texts;
    for (const Value* cell : cells) texts.push_back(cell->is_null() ? "" : to_text(*cell));
    hdf5::write_texts(group, name, texts);
}

void write_columns(hid_t file, const ResultsTable& table) {
    const hdf5::Handle group = hdf5::create_group(file, "runs");
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
        std::vector<const Value*> cells;
        for (const auto& row : table.rows) cells.push_back(&row[c]);
        // A slash would make a group.
        std::string name = table.columns[c];
        std::ranges::replace(name, '/', '_');
        write_column(group.id(), name, cells);
    }
}

void write_links(hid_t file, const fs::path& folder, const std::vector<Listed>& runs) {
    const hdf5::Handle group = hdf5::create_group(file, "traces");
    for (const Listed& listed : runs) {
        const RunFolder run(run_path(folder, *listed.run));
        if (!fs::exists(run.trace())) continue;
        hdf5::link_external(group.id(), std::to_string(listed.run->index),
                            run.trace().lexically_relative(folder).string());
    }
}

}  // namespace

void write_results_file(const fs::path& path, const ResultsTable& table, const fs::path& folder,
                        const std::vector<Listed>& runs) {
    write_hdf5_file(path, "weft-batch-results", [&](hid_t file) {
        hdf5::write_int_attribute(file, "format_version", std::vector{1});
        write_columns(file, table);
        write_links(file, folder, runs);
    });
}

}  // namespace weft::batch
