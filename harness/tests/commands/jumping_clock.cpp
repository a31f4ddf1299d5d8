#include <cstdlib>
#include <ctime>

#include <dlfcn.h>
#include <sys/time.h>

// Preloaded into the program: the time of day jumps forth and back by ever more days, each time that it is
// asked for. Clocks that count seconds since some start are left alone; but where CAROM_TEST_SLEEPS is set,
// the one that goes on while a machine sleeps does so for an hour each time.

namespace {

std::time_t jump() {
    static int asked = 0;
    ++asked;
    return (asked % 2 == 1 ? 1 : -1) * 1'000'000L * asked;
}

} // namespace

extern "C" {

int clock_gettime(clockid_t clock_id, timespec* tp) noexcept {
    static const auto real =
        reinterpret_cast<int (*)(clockid_t, timespec*)>(dlsym(RTLD_NEXT, "clock_gettime"));
    const int result = real(clock_id, tp);
    if (clock_id == CLOCK_REALTIME || clock_id == CLOCK_REALTIME_COARSE) {
        tp->tv_sec += jump();
    }
    if (clock_id == CLOCK_BOOTTIME && std::getenv("CAROM_TEST_SLEEPS") != nullptr) {
        static std::time_t slept = 0;
        tp->tv_sec += slept += 3600;
    }
    return result;
}

int gettimeofday(timeval* tv, void* tz) noexcept {
    static const auto real = reinterpret_cast<int (*)(timeval*, void*)>(dlsym(RTLD_NEXT, "gettimeofday"));
    const int result = real(tv, tz);
    tv->tv_sec += jump();
    return result;
}

std::time_t time(std::time_t* timer) noexcept {
    timespec now{};
    clock_gettime(CLOCK_REALTIME, &now);
    if (timer != nullptr) {
        *timer = now.tv_sec;
    }
    return now.tv_sec;
}
}
