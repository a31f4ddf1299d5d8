#include "variants/registry.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "variants/event_driven_variant.hpp"
#include "variants/parts.hpp"
#include "variants/table.hpp"

namespace carom {
namespace {

template <std::size_t... part> auto in_the_order_of_the_table(std::index_sequence<part...>) {
    std::array<Variant, table.size()> all{};
    const auto place = [&all](std::size_t row, std::span<const Variant> every_so_many) {
        for (const Variant& variant : every_so_many) {
            all[row] = variant;
            row += parts;
        }
    };
    (place(part, variants_of_part<part>()), ...);
    return all;
}

} // namespace

std::span<const Variant> variants() {
    static const auto all = in_the_order_of_the_table(std::make_index_sequence<parts>{});
    return all;
}

const Variant* find_variant(std::string_view name) {
    const auto found = std::ranges::find(variants(), name, &Variant::name);
    if (found != variants().end()) {
        return &*found;
    }
    return name == event_driven().name ? &event_driven() : nullptr;
}

} // namespace carom
