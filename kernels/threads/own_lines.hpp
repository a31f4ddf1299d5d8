#pragma once

#include <cstddef>
#include <limits>
#include <new>
#include <type_traits>
#include <vector>

namespace carom {

/// How much memory, in bytes, moves between processors at a time: what different threads write lies as far
/// apart. True of x86-64 and most of Arm; where lines are longer, threads are slower and results the same.
/// (std::hardware_destructive_interference_size varies with -mtune, and clang 14 lacks it.)
inline constexpr int cache_line = 64;

/// The allocator of memory that begins where a cache line does and shares its last line with nothing.
template <class T> struct OwnLines {
    using value_type = T;

    OwnLines() = default;
    template <class Other> OwnLines(const OwnLines<Other>& /*other*/) noexcept {}

    T* allocate(std::size_t count) {
        constexpr std::size_t line = cache_line;
        if (count > (std::numeric_limits<std::size_t>::max() - line) / sizeof(T)) {
            throw std::bad_array_new_length();
        }
        const std::size_t bytes = (count * sizeof(T) + line - 1) / line * line;
        return static_cast<T*>(::operator new(bytes, alignment));
    }

    void deallocate(T* memory, std::size_t /*count*/) noexcept { ::operator delete(memory, alignment); }

    friend bool operator==(const OwnLines& /*one*/, const OwnLines& /*other*/) { return true; }

  private:
    static constexpr std::align_val_t alignment{alignof(T) > cache_line ? alignof(T)
                                                                        : std::size_t{cache_line}};
};

/// What one thread writes while others write elsewhere.
template <class T> using OwnVector = std::vector<T, OwnLines<T>>;

/// The same, but leaves the elements of a vector as the memory comes, to be written before they are read.
/// Systems give memory when it is first touched, near the processor that does: so the threads that work on a
/// vector get it side by side, each what it will use, and nothing is written in vain.
template <class T> struct Untouched : OwnLines<T> {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

    Untouched() = default;
    template <class Other> Untouched(const Untouched<Other>& /*other*/) noexcept {}

    template <class Other> struct rebind { // NOLINT(readability-identifier-naming)
        using other = Untouched<Other>;
    };

    void construct(T* /*element*/) const noexcept {}
    template <class Value> void construct(T* element, const Value& value) const noexcept {
        new (static_cast<void*>(element)) T(value);
    }
};

template <class T> using UntouchedVector = std::vector<T, Untouched<T>>;

} // namespace carom
