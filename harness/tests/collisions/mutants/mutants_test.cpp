#include <cstddef>
#include <map>
#include <optional>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/measure/measure.hpp"
#include "harness/scenes/generate.hpp"
#include "harness/scenes/hard_cases.hpp"
#include "harness/support/input_file.hpp"
#include "harness/tests/collisions/mutants/mutant.hpp"
#include "kernels/tests/scenes.hpp"
#include "variants/registry.hpp"

// Bugs that a change of the kernel could bring: each is caught by what `carom check` runs, on the scene that
// mutants.json names for it, with the words that stand there; and the kernel as it is passes there.

namespace carom {
namespace {

struct Mutant {
    std::string name;
    std::string variant;
    std::string scene;
    std::string caught_by;
    int threads;
    int substeps;
};

void PrintTo(const Mutant& mutant, std::ostream* stream) { *stream << mutant.name; }

std::vector<Mutant> read_mutants() {
    std::vector<Mutant> mutants;
    for (const auto& json : nlohmann::json::parse(read_file(std::string(CAROM_MUTANTS) + "/mutants.json"))) {
        mutants.push_back({json["name"], json["variant"], json["scene"], json["caught_by"],
                           json.value("threads", 1), json.value("substeps", 1)});
    }
    return mutants;
}

Scene gas(double side, int count, double slowest, double fastest) {
    return generate({.count = count,
                     .side = side,
                     .radius = 1,
                     .steps = 6,
                     .least_velocity = slowest,
                     .largest_velocity = fastest,
                     .seed = 41,
                     .placement = Placement::lattice,
                     .isotropic = true});
}

/// Scenes by name: some of their own, and the hard cases.
Scene scene_of(const std::string& name) {
    const std::map<std::string, Scene (*)()> scenes{
        {"dilute", [] { return gas(100, 300, 0.1, 1); }},
        {"medium", [] { return gas(50, 300, 0.1, 1); }},
        {"dense", [] { return gas(36, 300, 0.05, 0.4); }},
        {"quick", [] { return gas(60, 300, 2, 4); }},
        {"overlapping", [] { return tests::random_scene(300, 40, 1, 6, 1, 42); }},
        {"crowded", [] { return tests::random_scene_of_density(300, 0.9, 6, 43); }},
        {"clusters", [] { return tests::random_scene(300, 40, 0.1, 20, 1, 44); }},
        {"clustered",
         [] { // in one corner of a large box, so that the cells hold several
             Scene scene = gas(36, 200, 0.1, 1);
             scene.side = 200;
             return scene;
         }},
        {"touching",
         [] {
             return Scene{.side = 20, .radius = 1, .steps = 3, .discs = {{8, 10, 0.5, 0}, {10, 10, 0, 0}}};
         }},
    };
    const auto found = scenes.find(name);
    return found != scenes.end() ? found->second() : find_hard_case(name)->scene();
}

/// The mutant that runs in place of its variant.
mutants::Simulate chosen = nullptr;

class Mutated final : public Simulation {
  public:
    Mutated(const Scene& scene, const Tuning& tuning, mutants::Tell tell)
        : tuning_(tuning), tell_(std::move(tell)) {
        restart(scene);
    }

    Tally step() override { return {.settled = simulation_->step()}; }

    void restart(const Scene& scene) override {
        mutants::Scene plain{scene.side, scene.radius, {}};
        for (const Disc& disc : scene.discs) {
            plain.discs.push_back({disc.x, disc.y, disc.vx, disc.vy});
        }
        simulation_ = chosen(plain, {tuning_.threads, tuning_.substeps, tuning_.sweep_limit}, tell_);
    }

    std::vector<Disc> discs() const override {
        std::vector<Disc> discs;
        for (const auto& [x, y, vx, vy] : simulation_->discs()) {
            discs.push_back({x, y, vx, vy});
        }
        return discs;
    }

  private:
    Tuning tuning_;
    mutants::Tell tell_;
    std::unique_ptr<mutants::Simulation> simulation_;
};

Disc disc_of(const mutants::Disc& plain) { return {plain[0], plain[1], plain[2], plain[3]}; }

Variant mutated(const Mutant& mutant) {
    chosen = mutants::all().at(mutant.name);
    Variant variant = *find_variant(mutant.variant);
    variant.simulate = [](const Scene& scene, const Tuning& tuning) -> std::unique_ptr<Simulation> {
        return std::make_unique<Mutated>(scene, tuning, [](const mutants::Collision&) {});
    };
    variant.simulate_logged = [](const Scene& scene, const Tuning& tuning,
                                 CollisionLog<double>& log) -> std::unique_ptr<Simulation> {
        return std::make_unique<Mutated>(scene, tuning, [&log](const mutants::Collision& told) {
            log.collided({told.time, told.sweep, told.first, told.second, disc_of(told.first_after),
                          disc_of(told.second_after)});
        });
    };
    return variant;
}

/// What the check says, as the verb has it.
std::string said_of(const Mutant& mutant, const Variant& variant) {
    const Tuning tuning{.threads = mutant.threads, .substeps = mutant.substeps, .sweep_limit = 500};
    return checked_run(scene_of(mutant.scene), variant, tuning).violation.value_or("nothing");
}

class Mutants : public testing::TestWithParam<Mutant> {};

TEST_P(Mutants, IsCaught) {
    EXPECT_PRED_FORMAT2(testing::IsSubstring, GetParam().caught_by, said_of(GetParam(), mutated(GetParam())));
    EXPECT_EQ(said_of(GetParam(), *find_variant(GetParam().variant)), "nothing") << "as it is";
}

INSTANTIATE_TEST_SUITE_P(Kernel, Mutants, testing::ValuesIn(read_mutants()),
                         [](const auto& mutant) { return mutant.param.name; });

/// The page has a row for each, and none for another.
TEST(MutantsPage, ListsEachWithTheCheckThatCatchesIt) {
    const std::string page = read_file(std::string(CAROM_MUTANTS) + "/README.md");
    std::size_t rows = 0;
    for (std::size_t at = page.find("\n| `"); at != std::string::npos; at = page.find("\n| `", at + 1)) {
        ++rows;
    }
    const std::vector<Mutant> mutants = read_mutants();
    EXPECT_EQ(rows, mutants.size());
    for (const Mutant& mutant : mutants) {
        const std::size_t row = page.find("\n| `" + mutant.name + "` |");
        ASSERT_NE(row, std::string::npos) << mutant.name;
        const std::string line = page.substr(row + 1, page.find('\n', row + 1) - row - 1);
        EXPECT_PRED_FORMAT2(testing::IsSubstring, "| " + mutant.scene + " |", line);
        EXPECT_PRED_FORMAT2(testing::IsSubstring, mutant.caught_by, line);
    }
}

} // namespace
} // namespace carom
