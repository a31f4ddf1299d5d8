#include "harness/commands/simulation_options.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <string_view>
#include <vector>

#include "harness/machine/threads.hpp"
#include "harness/support/errors.hpp"
#include "harness/verify/rounding.hpp"
#include "variants/fastest.hpp"

namespace carom {
namespace {

constexpr int most = 1'000'000'000;

/// Levenshtein's distance: the fewest letters to insert, delete or replace.
std::size_t edit_distance(std::string_view one, std::string_view two) {
    std::vector<std::size_t> row(two.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (const char letter : one) {
        std::size_t diagonal = row[0]++;
        for (std::size_t k = 0; k < two.size(); ++k) {
            const std::size_t replaced = diagonal + (letter != two[k]);
            diagonal = row[k + 1];
            row[k + 1] = std::min({diagonal + 1, row[k] + 1, replaced});
        }
    }
    return row.back();
}

} // namespace

void add_simulation_options(CLI::App& command, SimulationOptions& options) {
    options.tuning.threads = default_threads();
    command.add_option("SCENE", options.scene, "Scene file: N, L, r, S, then N lines `i x y vx vy`")
        ->required();
    command.add_option("THREADS,--threads", options.tuning.threads, "OpenMP threads")
        ->check(CLI::Range(1, most_threads))
        ->capture_default_str();
    command
        .add_option("--variant", options.variant,
                    "Name from `carom list`, or auto: the fastest for the scene")
        ->capture_default_str();
    add_tuning_options(command, options.tuning);
}

void add_tuning_options(CLI::App& command, Tuning& tuning) {
    const std::map<std::string, Tolerance> tolerances{{"relative", Tolerance::relative},
                                                      {"published", Tolerance::published}};
    const auto add = [&command](const char* name, int& value, const char* help) {
        command.add_option(name, value, help)->check(CLI::Range(1, most))->capture_default_str();
    };
    add("--find-chunk", tuning.find_chunk, "Boxes a thread takes at a time, if find has a chunk");
    add("--resolve-chunk", tuning.resolve_chunk,
        "Boxes or rows a thread takes at a time, if resolve has a chunk");
    add("--substeps", tuning.substeps, "Steps per unit of time, dt = 1/K");
    add("--sweep-limit", tuning.sweep_limit, "Sweeps after which a resolve is given up");
    command
        .add_option("--tolerance", tuning.tolerance,
                    "What counts as approaching: relative or published (1e-7)")
        ->transform(CLI::CheckedTransformer(tolerances).description(""))
        ->default_str("relative");
}

const Variant& require_variant(const std::string& name) {
    if (const Variant* variant = find_variant(name)) {
        return *variant;
    }
    const auto nearest = std::ranges::min_element(
        variants(), {}, [&name](const Variant& variant) { return edit_distance(name, variant.name); });
    throw InputError("--variant: found '" + name + "', expected a name from `carom list`, such as '" +
                     std::string(nearest->name) + "'");
}

const Variant& require_variant(const std::string& name, const Scene& scene) {
    const Variant& variant = name == automatic ? fastest_variant(scene) : require_variant(name);
    if (!holds(variant.policies, scene)) {
        throw InputError("--variant " + name +
                         ": computes in float, and the scene has numbers beyond 1e15, a radius below "
                         "1e-15, or a fastest speed whose product with the radius is not within 1e-15 "
                         "to 1e17; expected a variant in double");
    }
    return variant;
}

} // namespace carom
