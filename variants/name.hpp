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

/// `take(policy, prefix, axis)` for each policy, in the order of `Policies`. A choice whose word does not
/// tell its policy is prefixed with it in the name of a variant.
template <class Take> constexpr void for_each_policy(const Take& take) {
    take("neighbourhood", "", &Policies::neighbourhood);
    take("order", "", &Policies::order);
    take("self_contained", "self_contained_", &Policies::self_contained);
    take("direction", "", &Policies::direction);
    take("find_schedule", "find_", &Policies::find_schedule);
    take("resolve_schedule", "resolve_", &Policies::resolve_schedule);
    take("storage", "", &Policies::storage);
    take("prefetch", "prefetch_", &Policies::prefetch);
    take("box_side", "", &Policies::box_side);
    take("overlaps", "", &Policies::overlaps);
    take("search", "", &Policies::search);
    take("worklist", "", &Policies::worklist);
    take("impact", "", &Policies::impact);
    take("precision", "", &Policies::precision);
}

/// The one name of a combination of policies: what differs from the published best, joined by "-", in the
/// order of `Policies`; "published" where nothing does.
constexpr Name name_of(const Policies& policies) {
    Name name;
    for_each_policy([&](const char* /*policy*/, const char* prefix, auto axis) {
        if (policies.*axis != Policies{}.*axis) {
            name += name.empty() ? "" : "-";
            name += prefix;
            name += word(policies.*axis);
        }
    });
    if (name.empty()) {
        name += "published";
    }
    return name;
}

} // namespace carom
