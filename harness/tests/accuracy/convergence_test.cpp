#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/accuracy/error_measures.hpp"
#include "harness/tests/scenes/gas.hpp"
#include "harness/verify/rounding.hpp"
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

/// Short enough that chaos, which multiplies an error at every further collision, has not begun.
Scene short_scene() { return tests::gas(400, 64, 2, 0.25, 0.75, 31); }

class Convergence : public testing::TestWithParam<Variant> {};
class ConvergenceAtContact : public testing::TestWithParam<Variant> {};

/// A contact is seen up to dt late, up to v dt deep and under a normal that is off by up to v dt / 2r: the
/// path after it errs in proportion to dt. So does the depth itself.
TEST_P(Convergence, ErrorsFallWithTheStepInFirstOrder) {
    const Scene scene = short_scene();
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

/// Collisions at their time of contact, in the order of time, are exact. What is not is what a step cannot
/// see: discs that a collision moved into others not near them, and those that met and are no longer near.
/// Both take several collisions of a disc, or a way as long as the disc, within one step.
TEST_P(ConvergenceAtContact, IsExactInStepsOfAnEighth) {
    const double rounding = 1e5 * rounding_of(GetParam().policies).epsilon();
    const ErrorMeasures measures = measure_errors(short_scene(), GetParam(), {.substeps = 8});
    ASSERT_TRUE(measures.reference) << measures.reference_reason;
    EXPECT_GT(measures.collision_rate.value(), 0.1);
    EXPECT_LT(measures.reference->trajectory.back().rms_distance, rounding);
    EXPECT_EQ(measures.penetration_worst, 0);
    EXPECT_EQ(measures.unresolved_pairs, 0);
}

std::vector<Variant> variants_with(Impact impact) {
    std::vector<Variant> found;
    std::ranges::copy_if(variants(), std::back_inserter(found),
                         [=](const Variant& variant) { return variant.policies.impact == impact; });
    return found;
}

INSTANTIATE_TEST_SUITE_P(Registry, Convergence, testing::ValuesIn(variants_with(Impact::step_end)),
                         tests::variant_test_name);
INSTANTIATE_TEST_SUITE_P(Registry, ConvergenceAtContact, testing::ValuesIn(variants_with(Impact::at_contact)),
                         tests::variant_test_name);

} // namespace
} // namespace carom
