#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <string>

#include "kernels/scene.hpp"
#include "kernels/tests/scenes.hpp"

namespace carom::tests {

/// What one awkward scene is made with.
class AwkwardScene {
  public:
    explicit AwkwardScene(std::uint64_t seed) : random_(seed) {}

    /// Up to 200 discs, none among them; of sizes and speeds over a hundred orders of magnitude; in boxes
    /// from one disc's width to many; overlapping, touching, coincident, at walls, outside, at rest.
    Scene make() {
        const int kind = random_.below(8);
        const int count = kind < 2 || random_.coin() ? random_.below(12) : random_.below(201);
        scene_.steps = 1 + random_.below(3);
        scene_.radius = one_in(4) ? random_.magnitude(-50, 50) : random_.uniform(0.5, 20);
        scene_.side = side(kind, count);
        speed_ = scene_.radius * (one_in(4) ? random_.magnitude(-30, 8) : random_.magnitude(-2, 1));
        for (int i = 0; i < count; ++i) {
            Disc disc;
            place(disc);
            disc.vx = bounded(velocity());
            disc.vy = bounded(velocity());
            scene_.discs.push_back(disc);
        }
        return scene_;
    }

  private:
    bool one_in(int count) { return random_.below(count) == 0; }
    static double bounded(double number) { return std::clamp(number, -1e60, 1e60); }

    /// A box that holds few discs at most is never filled with many: they would all overlap each other.
    double side(int kind, int count) {
        const double radius = scene_.radius;
        const double filled = std::sqrt(std::max(1, count) * std::numbers::pi) * radius;
        switch (kind) {
        case 0:
            return 2 * radius;
        case 1:
            return radius * random_.uniform(2, 9);
        case 2:
            return radius * random_.uniform(20, 200);
        default:
            return std::max(2 * radius, filled / std::sqrt(random_.uniform(0.01, 1.2)));
        }
    }

    /// Into the box or, now and then, beside it, onto its edges, or against a disc that is there already.
    void place(Disc& disc) {
        const double side = scene_.side;
        disc.x = random_.uniform(0, side);
        disc.y = random_.uniform(0, side);
        switch (random_.below(12)) {
        case 0:
            disc.x = random_.uniform(-2, 3) * side;
            break;
        case 1:
            disc.y = bounded((random_.coin() ? 1 : -1) * random_.magnitude(0, 8) * side);
            break;
        case 2:
            disc.x = random_.coin() ? scene_.radius : side - scene_.radius;
            break;
        case 3:
            disc.y = (4 * scene_.radius + 1) * random_.below(8);
            break;
        case 4:
        case 5:
            beside_another(disc);
            break;
        default:
            break;
        }
    }

    void beside_another(Disc& disc) {
        if (scene_.discs.empty()) {
            return;
        }
        const auto last = static_cast<int>(scene_.discs.size());
        const Disc& other = scene_.discs[static_cast<std::size_t>(random_.below(last))];
        disc.x = other.x;
        disc.y = other.y;
        switch (random_.below(4)) {
        case 0:
            return;
        case 1:
            disc.x += 2 * scene_.radius;
            return;
        case 2:
            disc.y -= scene_.radius * random_.magnitude(-20, 0);
            return;
        default:
            disc.x += scene_.radius * random_.uniform(-2, 2);
            disc.y += scene_.radius * random_.uniform(-2, 2);
        }
    }

    double velocity() {
        switch (random_.below(8)) {
        case 0:
            return 0;
        case 1:
            return speed_ * (random_.below(5) - 2);
        case 2:
            return speed_ * random_.uniform(-1, 1) * random_.magnitude(-16, 2);
        default:
            return speed_ * random_.uniform(-1, 1);
        }
    }

    Random random_;
    Scene scene_;
    double speed_ = 0;
};

/// How many scenes a run of the tests takes: CAROM_FUZZ_SCENES, or 1000.
inline std::uint64_t fuzz_scenes() {
    const char* wanted = std::getenv("CAROM_FUZZ_SCENES");
    return wanted == nullptr ? 1000 : std::stoull(wanted);
}

/// The awkward scene of that number, the same on every platform.
inline Scene awkward_scene(std::uint64_t seed) { return AwkwardScene(seed).make(); }

} // namespace carom::tests
