#include "harness/counters/papi.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <mutex>
#include <string_view>

#include <dlfcn.h>
#include <papi.h>
#include <pthread.h>

#include "harness/counters/access.hpp"
#include "harness/support/silence.hpp"

namespace carom {
namespace {

constexpr std::array<std::string_view, 9> software_events{
    "perf::CPU-CLOCK",      "perf::TASK-CLOCK",   "perf::PAGE-FAULTS",
    "perf::MINOR-FAULTS",   "perf::MAJOR-FAULTS", "perf::CONTEXT-SWITCHES",
    "perf::CPU-MIGRATIONS", "perf::CS",           "perf::MIGRATIONS"};

/// They happen in the kernel: counted in user mode they would be zero.
constexpr std::array<std::string_view, 4> kernel_events{"perf::CONTEXT-SWITCHES", "perf::CS",
                                                        "perf::CPU-MIGRATIONS", "perf::MIGRATIONS"};

/// PAPI counts nothing, not even software events, unless its libpfm finds the PMU of a CPU. Where there is
/// none at all, libpfm is initialised once with the first PMU that it knows, which then stays marked as
/// present, and is left with the software events alone.
class SoftwareEventsAlone {
  public:
    SoftwareEventsAlone() {
        const auto initialize = reinterpret_cast<int (*)()>(dlsym(RTLD_DEFAULT, "pfm_initialize"));
        const auto terminate = reinterpret_cast<void (*)()>(dlsym(RTLD_DEFAULT, "pfm_terminate"));
        if (initialize == nullptr || terminate == nullptr || std::getenv(variable) != nullptr ||
            !lacks_pmu(read_perf_access())) {
            return;
        }
        setenv(variable, "", 1);
        initialize();
        terminate();
        setenv(variable, "perf", 1);
        set_ = true;
    }
    ~SoftwareEventsAlone() {
        if (set_) {
            unsetenv(variable);
        }
    }
    SoftwareEventsAlone(const SoftwareEventsAlone&) = delete;
    SoftwareEventsAlone& operator=(const SoftwareEventsAlone&) = delete;

  private:
    static constexpr const char* variable = "LIBPFM_FORCE_PMU";
    bool set_ = false;
};

/// Why PAPI cannot be used, or an empty text.
std::string initialize_papi() {
    const Silence silence;
    const SoftwareEventsAlone guard;
    PAPI_set_debug(PAPI_QUIET);
    const int version = PAPI_library_init(PAPI_VER_CURRENT);
    if (version != PAPI_VER_CURRENT) {
        return version > 0 ? "PAPI's library is of another version than its header"
                           : std::string("PAPI_library_init: ") + PAPI_strerror(version);
    }
    const int threads = PAPI_thread_init([] { return static_cast<unsigned long>(pthread_self()); });
    if (threads != PAPI_OK) {
        return std::string("PAPI_thread_init: ") + PAPI_strerror(threads);
    }
    const auto* component = PAPI_get_component_info(PAPI_get_component_index("perf_event"));
    if (component == nullptr || component->disabled != PAPI_OK) {
        return "PAPI " + papi_version() + " has no perf_event" +
               (component == nullptr ? "" : std::string(": ") + component->disabled_reason);
    }
    return "";
}

/// What that said, at the first call.
const std::string& papi_error() {
    static const std::string error = initialize_papi();
    return error;
}

class PapiEventSet : public EventSet {
  public:
    explicit PapiEventSet(CountedMode mode) : mode_(mode) {
        require(PAPI_register_thread(), "PAPI_register_thread");
        require(PAPI_create_eventset(&set_), "PAPI_create_eventset");
    }

    ~PapiEventSet() override {
        if (running_) {
            PAPI_stop(set_, values_.data());
        }
        PAPI_cleanup_eventset(set_);
        PAPI_destroy_eventset(&set_);
    }

    PapiEventSet(const PapiEventSet&) = delete;
    PapiEventSet& operator=(const PapiEventSet&) = delete;

    void add(const std::string& event) override {
        const std::scoped_lock lock(adding());
        int code = 0;
        if (PAPI_event_name_to_code(event.c_str(), &code) != PAPI_OK) {
            throw_unknown(event);
        }
        set_mode(event, PAPI_get_event_component(code));
        const int added = PAPI_add_event(set_, code);
        if (added == PAPI_ENOEVNT) {
            throw_unknown(event);
        }
        require(added, event);
        values_.push_back(0);
    }

    void start() override {
        require(PAPI_start(set_), "PAPI_start");
        running_ = true;
    }

    std::vector<double> stop() override {
        running_ = false;
        require(PAPI_stop(set_, values_.data()), "PAPI_stop");
        return {values_.begin(), values_.end()};
    }

  private:
    /// The mode is a setting of the whole process: it must not change while another thread adds.
    static std::mutex& adding() {
        static std::mutex mutex;
        return mutex;
    }

    [[noreturn]] static void throw_unknown(const std::string& event) {
        throw CounterError((event.starts_with("PAPI_") ? "preset " : "event ") + event +
                           " is unknown to PAPI " + papi_version() + " on this CPU");
    }

    static void require(int result, const std::string& what) {
        if (result != PAPI_OK) {
            throw CounterError(what + ": " + PAPI_strerror(result));
        }
    }

    void set_mode(const std::string& event, int component) const {
        const bool in_kernel = mode_ == CountedMode::user_and_kernel;
        const int set =
            PAPI_set_cmp_domain(in_kernel ? PAPI_DOM_USER | PAPI_DOM_KERNEL : PAPI_DOM_USER, component);
        if (set != PAPI_OK && std::ranges::find(kernel_events, event) != kernel_events.end()) {
            throw CounterError(event + " happens in the kernel, which PAPI may not count");
        }
    }

    CountedMode mode_;
    int set_ = PAPI_NULL;
    bool running_ = false;
    std::vector<long long> values_;
};

} // namespace

std::string papi_version() {
    const int version = PAPI_get_opt(PAPI_LIB_VERSION, nullptr);
    return std::to_string(PAPI_VERSION_MAJOR(version)) + "." + std::to_string(PAPI_VERSION_MINOR(version)) +
           "." + std::to_string(PAPI_VERSION_REVISION(version));
}

bool knows_event(const std::string& event) {
    int code = 0;
    return !papi_error().empty() || PAPI_event_name_to_code(event.c_str(), &code) == PAPI_OK;
}

bool is_software_event(const std::string& event) {
    return std::ranges::find(software_events, event) != software_events.end();
}

std::unique_ptr<EventSet> papi_event_set(CountedMode mode) {
    if (const std::string& error = papi_error(); !error.empty()) {
        throw CounterError(error);
    }
    return std::make_unique<PapiEventSet>(mode);
}

} // namespace carom
