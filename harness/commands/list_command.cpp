#include <cstdio>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/commands/commands.hpp"
#include "harness/records/policies_json.hpp"
#include "variants/event_driven_variant.hpp"
#include "variants/name.hpp"
#include "variants/registry.hpp"

namespace carom {
namespace {

void print_names(bool as_json) {
    auto list = nlohmann::ordered_json::array();
    std::vector<Variant> all(variants().begin(), variants().end());
    all.push_back(event_driven());
    for (const Variant& variant : all) {
        list.push_back({{"name", variant.name},
                        {"policies", policies_json(variant.policies, variant.engine)},
                        {"same_bits", {{"threads", true}, {"compilers", true}}}});
        std::cout << (as_json ? "" : std::string(variant.name) + "\n");
    }
    std::cout << (as_json ? list.dump(2) + "\n" : "");
}

std::string word_of(const nlohmann::ordered_json& choice) {
    return choice.is_null() ? "-" : choice.get<std::string>();
}

/// The policies of the published best, the names, which say in what each variant differs, and what all
/// promise.
///
/// That is held by every variant, and tested of each. The sequential orders resolve on one thread; in the
/// parallel ones no two iterations of a loop touch one disc (the proof is in kernels/sweep.hpp), and the
/// lists of overlaps do not depend on who finds them. Every operation is one of IEEE 754's, in an order that
/// the source fixes.
void print_table() {
    const auto policies = policies_json(variants().front().policies, Engine::steps);
    for (const Variant& variant : variants()) {
        std::printf("%s\n", std::string(variant.name).c_str());
        if (&variant == &variants().front()) {
            for (const auto& [policy, choice] : policies.items()) {
                std::printf("    %-16s  %s\n", policy.c_str(), word_of(choice).c_str());
            }
            std::printf("every other one differs from it in what its name says:\n");
        }
    }
    std::printf("\nThe final state is the same, to the last bit,\n"
                "  for any number of threads, any schedule and any chunk: all of them\n"
                "  with every compiler, contraction off:                  all of them\n"
                "\nWithout steps, and with none of these policies:\n"
                "%s\n"
                "    every collision at its time, in order, exact to rounding; on one thread where\n"
                "    more do not pay; no --substeps, no phases to profile, no scene whose discs overlap at "
                "the start\n",
                std::string(event_driven().name).c_str());
}

} // namespace

void add_list_command(CLI::App& program) {
    auto all_as_json = std::make_shared<bool>(false);
    auto names_alone = std::make_shared<bool>(false);
    CLI::App* command = program.add_subcommand("list", "List the variants, the published best first");
    auto* names = command->add_flag("--names", *names_alone, "One name a line");
    command->add_flag("--json", *all_as_json, "Names and policies as JSON")->excludes(names);
    command->callback([all_as_json, names_alone] {
        if (*all_as_json || *names_alone) {
            print_names(*all_as_json);
        } else {
            print_table();
        }
    });
}

} // namespace carom
