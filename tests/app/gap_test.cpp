// The reality gap as a user meets it: `tandem fit`, <fitted>, `tandem gap`.
#include <algorithm>
#include <gtest/gtest.h>

#include "hal/json/json.hpp"
#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem {
namespace {

using scenarios::Folder;
using scenarios::Tandem;
using scenarios::text_of;

const std::string kExperiment = std::string(test::kSourceDir) + "/configs/epuck_diffusion.xml";

std::string output_of(const Folder& folder, const std::vector<std::string>& arguments, int code = 0) {
  Tandem tandem(arguments, folder.path());
  EXPECT_EQ(tandem.wait(60), code) << tandem.errors();
  return code == 0 ? tandem.output() : tandem.errors();
}

constexpr const char* kHidden = R"(<fitted version="1"><model kind="e-puck">
<fitted_wheels><mean left="0.97" right="1.02" base="1.03" noise="0.002" delay="130 ms"/></fitted_wheels>
<fitted_proximity><mean gain="0.9" exponent="1.2" offset="2 mm" delay="120 ms"/></fitted_proximity>
</model></fitted>)";

TEST(RealityGap, IsClosedByWhatARecordTells) {
  Folder folder;
  folder.write("hidden.xml", kHidden);
  output_of(folder, {"run", kExperiment, "--quiet", "--set", "fitted.file=hidden.xml", "--set",
                     "record.ports=differential_steering,proximity", "--record", "r.record"});
  const std::string told =
      output_of(folder, {"fit", "r.record", "--robots", "ep1,ep2", "-o", "fitted.xml", "--report", "fit.json"});
  EXPECT_NE(told.find("left wheel"), std::string::npos) << told;
  EXPECT_NE(told.find("cannot be told"), std::string::npos) << "it has no encoders";
  const hal::Json fit = hal::parse_json(text_of(folder.path() / "fit.json")).value();
  for (const hal::Json& robot : fit["robots"]) {
    const hal::Json& wheels = robot["wheels"];
    EXPECT_NEAR(wheels["left"]["value"].get<double>(), 0.97, 0.01);
    EXPECT_NEAR(wheels["right"]["value"].get<double>(), 1.02, 0.01);
    EXPECT_NEAR(wheels["base"]["value"].get<double>(), 1.03, 0.002);
    EXPECT_NEAR(wheels["delay_s"]["value"].get<double>(), 0.13, 0.003);
    EXPECT_NEAR(robot["proximity"]["delay_s"]["value"].get<double>(), 0.12, 0.02);
  }

  // The same settings give the same run; plain robots another one; the fitted file is taken.
  const auto apart = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"gap", "r.record", "--robots", "ep1,ep2", "--report", "-"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return hal::parse_json(output_of(folder, arguments)).value()["median"]["apart_m"].get<double>();
  };
  EXPECT_EQ(apart({}), 0.0);
  folder.write("plain.xml", "<fitted version=\"1\"/>");
  EXPECT_GT(apart({"--fitted", "plain.xml"}), 0.05);
  EXPECT_GT(apart({"--fitted", "fitted.xml"}), 0.0);

  // What stands there is kept.
  folder.write("gap.json", "mine");
  Tandem gap({"gap", "r.record", "--robots", "ep1,ep2", "--report", "gap.json"}, folder.path());
  EXPECT_EQ(gap.wait(60), 0) << gap.errors();
  EXPECT_NE(gap.errors().find("the old 'gap.json' is kept as 'gap.json.bak'"), std::string::npos) << gap.errors();
  EXPECT_EQ(text_of(folder.path() / "gap.json.bak"), "mine");
  EXPECT_NE(text_of(folder.path() / "gap.json").find("median"), std::string::npos);
}

TEST(RealityGap, SaysWhatIsMissing) {
  Folder folder;
  output_of(folder, {"run", kExperiment, "--quiet", "--seconds", "5", "--record", "r.record"});
  EXPECT_NE(output_of(folder, {"fit", "r.record", "--robots", "ep1"}, 1).find("nothing was found"), std::string::npos);
  const std::string all = output_of(folder, {"fit", "r.record"}, 1);
  EXPECT_NE(all.find("\n  50 robots: wheels: "), std::string::npos) << all;
  EXPECT_NE(all.find("\n  50 robots: proximity: "), std::string::npos) << all;
  EXPECT_EQ(std::count(all.begin(), all.end(), '\n'), 3) << "a line for each reason, none for a robot: " << all;
  EXPECT_NE(output_of(folder, {"fit", "r.record", "--robots", "nobody"}, 1).find("there are: ep0"), std::string::npos);
  EXPECT_NE(output_of(folder, {"fit", kExperiment}, 1).find("error"), std::string::npos);
  EXPECT_NE(output_of(folder, {"gap", "r.record", "r.record", "--seed", "3"}, 2).find("two records"),
            std::string::npos);
}

}  // namespace
}  // namespace tandem
