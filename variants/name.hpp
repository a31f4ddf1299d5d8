#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "kernels/policies.hpp"
#include "variants/engine.hpp"

namespace carom {

constexpr std::string_view word(Neighbourhood value) {
    return value == Neighbourhood::nine ? "nine" : "four";
}

constexpr std::string_view word(Order value) {
    constexpr std::array<std::string_view, 7> words{"checkered", "row",    "track",    "repeat",
                                                    "once",      "strips", "wavefront"};
    return words[static_cast<std::size_t>(value)];
}

constexpr std::string_view word(SelfContained value) { return value == SelfContained::on ? "on" : "off"; }

constexpr std::string_view word(Direction value) {
    return value == Direction::reverse ? "reverse" : "forward";
}

constexpr std::string_view word(Schedule value) {
    constexpr std::array<std::string_view, 6> words{"static",        "static_chunk", "dynamic",
                                                    "dynamic_chunk", "guided",       "guided_chunk"};
    return words[static_cast<std::size_t>(value)];
}

constexpr std::string_view word(Storage value) { return value == Storage::sorted ? "sorted" : "numbered"; }
constexpr std::string_view word(Prefetch value) { return value == Prefetch::on ? "on" : "off"; }
constexpr std::string_view word(BoxSide value) { return value == BoxSide::snug ? "snug" : "wide"; }
constexpr std::string_view word(Overlaps value) { return value == Overlaps::contacts ? "contacts" : "lists"; }
constexpr std::string_view word(Search value) { return value == Search::filtered ? "filtered" : "exact"; }
constexpr std::string_view word(Worklist value) { return value == Worklist::active ? "active" : "all"; }
constexpr std::string_view word(Impact value) {
    return value == Impact::at_contact ? "at_contact" : "step_end";
}
constexpr std::string_view word(Engine value) { return value == Engine::steps ? "steps" : "event_driven"; }
constexpr std::string_view word(Precision value) { return value == Precision::float_ ? "float" : "double"; }

/// The name of a variant, built at compile time.
class Name {
  public:
    constexpr Name& operator+=(std::string_view part) {
        for (const char letter : part) {
            letters_.at(size_++) = letter;
        }
        return *this;
    }
    constexpr bool empty() const { return size_ == 0; }
    constexpr std::string_view view() const { return {letters_.data(), size_}; }

  private:
    std::array<char, 128> letters_{};
    std::size_t size_ = 0;
};

/// The one name of a combination of policies: what differs from the published best, joined by "-", in the
/// order of `Policies`; "published" where nothing does. A choice whose word does not tell its policy is
/// prefixed with it.
constexpr Name name_of(const Policies& policies) {
    constexpr Policies published{};
    Name name;
    const auto add = [&name](bool differs, std::string_view prefix, std::string_view choice) {
        if (differs) {
            name += name.empty() ? "" : "-";
            name += prefix;
            name += choice;
        }
    };
    add(policies.neighbourhood != published.neighbourhood, "", word(policies.neighbourhood));
    add(policies.order != published.order, "", word(policies.order));
    add(policies.self_contained != published.self_contained, "self_contained_",
        word(policies.self_contained));
    add(policies.direction != published.direction, "", word(policies.direction));
    add(policies.find_schedule != published.find_schedule, "find_", word(policies.find_schedule));
    add(policies.resolve_schedule != published.resolve_schedule, "resolve_", word(policies.resolve_schedule));
    add(policies.storage != published.storage, "", word(policies.storage));
    add(policies.prefetch != published.prefetch, "prefetch_", word(policies.prefetch));
    add(policies.box_side != published.box_side, "", word(policies.box_side));
    add(policies.overlaps != published.overlaps, "", word(policies.overlaps));
    add(policies.search != published.search, "", word(policies.search));
    add(policies.worklist != published.worklist, "", word(policies.worklist));
    add(policies.impact != published.impact, "", word(policies.impact));
    add(policies.precision != published.precision, "", word(policies.precision));
    if (name.empty()) {
        name += "published";
    }
    return name;
}

} // namespace carom
