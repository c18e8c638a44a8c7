#include "controllers/neural/policy.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "hal/random.hpp"

namespace tandem::controllers {
namespace {

std::string policy(const std::string& layers,
                   const std::string& inputs = R"({"port": "proximity", "field": "distance", "count": 2})") {
  return R"({"tandem_policy": 1, "inputs": [)" + inputs +
         R"(], "outputs": [{"port": "differential_steering", "field": "left", "scale": 0.1, "low": -1, "high": null}], "layers": [)" +
         layers + "]}";
}

std::string why_not(const std::string& text) {
  const auto parsed = parse_policy(text);
  return parsed.ok() ? "" : parsed.error().message;
}

double value(Activation activation, double x) {
  const Layer layer{1, 1, {1.0}, {0.0}, activation};
  double out = 0.0;
  evaluate(layer, std::span<const double>(&x, 1), std::span<double>(&out, 1));
  return out;
}

TEST(Policy, ReadsWhatItsFileSays) {
  auto parsed = parse_policy(policy(R"({"weights": [[1, -2.5]], "bias": [0.5], "activation": "tanh"})"));
  ASSERT_TRUE(parsed.ok()) << parsed.error().message;
  EXPECT_EQ(parsed->inputs[0].port, "proximity");
  EXPECT_EQ(parsed->inputs[0].count, 2U);
  EXPECT_EQ(parsed->outputs[0].scale, 0.1);
  EXPECT_EQ(parsed->outputs[0].low, -1.0);
  EXPECT_TRUE(std::isinf(parsed->outputs[0].high));
  EXPECT_EQ(parsed->layers[0].weights, (std::vector<double>{1.0, -2.5}));
  EXPECT_EQ(parsed->widest, 2U);
}

TEST(Policy, ActivatesAsItsNamesSay) {
  for (const double x : {-30.0, -2.0, -0.1, 0.0, 1e-9, 0.7, 25.0}) {
    EXPECT_EQ(value(Activation::Identity, x), x);
    EXPECT_EQ(value(Activation::Relu, x), x > 0.0 ? x : 0.0);
    EXPECT_NEAR(value(Activation::Tanh, x), std::tanh(x), 3e-16);
    EXPECT_NEAR(value(Activation::Sigmoid, x), 1.0 / (1.0 + std::exp(-x)), 3e-16);
  }
}

TEST(Policy, HasTheSameBitsOnEveryMachine) {
  hal::Random random(7);
  Layer hidden{24, 16, {}, {}, Activation::Tanh}, last{16, 2, {}, {}, Activation::Sigmoid};
  for (Layer* layer : {&hidden, &last}) {
    for (std::size_t i = 0; i < layer->inputs * layer->outputs; ++i)
      layer->weights.push_back(random.uniform(-1.0, 1.0));
    for (std::size_t i = 0; i < layer->outputs; ++i) layer->bias.push_back(random.uniform(-1.0, 1.0));
  }
  std::vector<double> in(24), middle(16), out(2);
  std::uint64_t sum = 0;
  for (int round = 0; round < 1000; ++round) {
    for (double& x : in) x = random.uniform(-1.0, 1.0);
    evaluate(hidden, in, middle);
    evaluate(last, middle, out);
    for (const double x : out) sum = sum * 1099511628211ULL + std::bit_cast<std::uint64_t>(x);
  }
  EXPECT_EQ(sum, 14151440773924679217ULL) << "of x86-64 and of boards";
}

TEST(Policy, SaysWhatIsWrongWithAFile) {
  const std::string good = R"({"weights": [[1, 2]], "bias": [0], "activation": "tanh"})";
  EXPECT_EQ(why_not(policy(good)), "");
  EXPECT_NE(why_not("[1]").find("no JSON object"), std::string::npos);
  EXPECT_NE(why_not("{}").find("\"tandem_policy\": 1"), std::string::npos);
  EXPECT_EQ(why_not(policy("")), "the policy has no list 'layers'");
  EXPECT_EQ(why_not(policy(R"({"weights": [[1]], "bias": [0], "activation": "tanh"})")),
            "layer 0 has a row of 1 weights, but 2 values come in");
  EXPECT_EQ(why_not(policy(R"({"weights": [[1, 2]], "bias": [0, 1], "activation": "tanh"})")),
            "layer 0 has 2 biases for 1 values");
  EXPECT_EQ(why_not(policy(R"({"weights": [[1, 2], [3, 4]], "bias": [0, 1], "activation": "tanh"})")),
            "the last layer has 2 values for 1 outputs");
  EXPECT_NE(why_not(policy(R"({"weights": [[1, null]], "bias": [0], "activation": "tanh"})")).find("no finite number"),
            std::string::npos);
  EXPECT_NE(why_not(policy(R"({"weights": [[1, 2]], "bias": [0], "activation": "cos"})"))
                .find("identity, relu, tanh, sigmoid"),
            std::string::npos);
  EXPECT_NE(why_not(policy(good, R"({"port": "proximity"})")).find("names no 'field'"), std::string::npos);
  EXPECT_NE(why_not(policy(good, R"({"port": "p", "field": "f", "count": -1})")).find("'count'"), std::string::npos);
  EXPECT_NE(why_not(policy(good, R"({"port": "p", "field": "f", "cuont": 1})")).find("'cuont', which is unknown"),
            std::string::npos);
  EXPECT_NE(why_not(policy(good, R"({"port": "p", "field": "f", "low": 2, "high": 1})")).find("'low' above"),
            std::string::npos);
}

}  // namespace
}  // namespace tandem::controllers
