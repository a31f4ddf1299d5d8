#include <cstdlib>
#include <fstream>
#include <string>
#include <system_error>

#include <unistd.h>

#include "harness/accuracy/costs.hpp"
#include "harness/machine/machine.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/note.hpp"
#include "harness/support/output_file.hpp"

namespace carom {
namespace {

constexpr int format_of_file = 1;

std::optional<Costs> costs_of(const nlohmann::json& json) {
    Costs costs{.machine = json.at("machine").get<std::string>(), .costs = {}};
    for (const auto& [name, rows] : json.at("seconds").items()) {
        for (const auto& row : rows) {
            costs.costs[name].push_back({.discs = row.at("discs"),
                                         .seconds = {.placed = row.at("placed"),
                                                     .moved = row.at("moved"),
                                                     .near = row.at("near"),
                                                     .collisions = row.at("collisions")}});
        }
    }
    const bool is_ours = json.at("format") == format_of_file && costs.machine == read_machine().cpu_model;
    return is_ours && !costs.costs.empty() ? std::optional(costs) : std::nullopt;
}

/// Throws InputError where the costs cannot be kept.
void require_place() {
    const std::filesystem::path path = costs_file();
    if (path.empty()) {
        throw InputError("XDG_CACHE_HOME and HOME: found neither, expected one, to keep the costs there");
    }
    std::error_code error;
    std::filesystem::create_directories(path.parent_path(), error);
    require_writable(path);
}

void keep(const Costs& costs) {
    auto json = costs_json(costs);
    json["format"] = format_of_file;
    write_text(costs_file(), json.dump(2) + "\n");
}

} // namespace

std::filesystem::path costs_file() {
    const char* cache = std::getenv("XDG_CACHE_HOME");
    const char* home = std::getenv("HOME");
    if (cache != nullptr && *cache == '/') {
        return std::filesystem::path(cache) / "carom" / "costs.json";
    }
    return home != nullptr && *home == '/' ? std::filesystem::path(home) / ".cache" / "carom" / "costs.json"
                                           : std::filesystem::path();
}

std::optional<Costs> kept_costs() {
    std::ifstream file(costs_file());
    if (!file) {
        return std::nullopt;
    }
    try {
        return costs_of(nlohmann::json::parse(file));
    } catch (const nlohmann::json::exception&) {
        return std::nullopt; // of another program, or damaged: as if there were none
    }
}

Costs costs_of_machine() {
    if (const auto kept = kept_costs()) {
        return *kept;
    }
    try {
        require_place();
        const Costs measured = measure_costs();
        if (const auto kept = kept_costs()) { // by another program in the meantime: it holds for both
            return *kept;
        }
        keep(measured);
        return measured;
    } catch (const InputError& error) {
        note(std::string("the costs of this machine cannot be kept (") + error.what() +
             "): the choice is made by those of another one");
    }
    return typical_costs();
}

} // namespace carom
