#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/accuracy/error_measures.hpp"
#include "harness/scenes/generate.hpp"
#include "variants/tests/each_variant.hpp"

namespace carom {
namespace {

/// Least squares of log y over log x: the exponent of a power law.
double fitted_order(const std::vector<double>& x, const std::vector<double>& y) {
    const auto count = static_cast<double>(x.size());
    double mean_x = 0;
    double mean_y = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        mean_x += std::log(x[i]) / count;
        mean_y += std::log(y[i]) / count;
    }
    double covariance = 0;
    double variance = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        covariance += (std::log(x[i]) - mean_x) * (std::log(y[i]) - mean_y);
        variance += (std::log(x[i]) - mean_x) * (std::log(x[i]) - mean_x);
    }
    return covariance / variance;
}

class Convergence : public testing::TestWithParam<Variant> {};

/// A contact is seen up to dt late, up to v dt deep and under a normal that is off by up to v dt / 2r: the
/// path after it errs in proportion to dt. So does the depth itself. Short enough that chaos, which
/// multiplies an error at every further collision, has not begun.
TEST_P(Convergence, ErrorsFallWithTheStepInFirstOrder) {
    const Scene scene = generate({.count = 400,
                                  .side = 64,
                                  .radius = 1,
                                  .steps = 2,
                                  .least_velocity = 0.25,
                                  .largest_velocity = 0.75,
                                  .seed = 31,
                                  .placement = Placement::random,
                                  .isotropic = true});
    std::vector<double> steps;
    std::vector<double> distances;
    std::vector<double> depths;
    for (int substeps = 1; substeps <= 64; substeps *= 2) {
        const ErrorMeasures measures = measure_errors(scene, GetParam(), {.substeps = substeps});
        ASSERT_TRUE(measures.reference) << measures.reference_reason;
        steps.push_back(1.0 / substeps);
        distances.push_back(measures.reference->trajectory.back().rms_distance);
        depths.push_back(measures.penetration_mean);
    }
    EXPECT_NEAR(fitted_order(steps, distances), 1, 0.25);
    EXPECT_NEAR(fitted_order(steps, depths), 1, 0.25);
    EXPECT_LT(distances.back(), distances.front() / 16);
    RecordProperty("order of the distance", std::to_string(fitted_order(steps, distances)));
    RecordProperty("order of the depth", std::to_string(fitted_order(steps, depths)));
}

INSTANTIATE_TEST_SUITE_P(Registry, Convergence, testing::ValuesIn(variants().begin(), variants().end()),
                         tests::variant_test_name);

} // namespace
} // namespace carom
