#pragma once

#include <memory>
#include <type_traits>
#include <vector>

namespace carom {

/// Leaves the elements of a vector as the memory comes, to be written before they are read. Systems give
/// memory when it is first touched, near the processor that does: so the threads that work on a vector get
/// it side by side, each what it will use, and nothing is written in vain.
template <class T> struct Untouched : std::allocator<T> {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

    template <class Other> struct rebind {
        using other = Untouched<Other>;
    };

    void construct(T* /*element*/) const noexcept {}
};

template <class T> using UntouchedVector = std::vector<T, Untouched<T>>;

} // namespace carom
