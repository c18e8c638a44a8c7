// Fitted parameters in experiments: from a file, from the experiment itself, and every way to get them wrong.
#include "core/config/fitted.hpp"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <unistd.h>

#include "hal/device/fitted.hpp"
#include "tests/core/config/reading.hpp"

namespace tandem::core {
namespace {

using testing::HasSubstr;

std::string with(const std::string& rest) {
  Parts parts;
  parts.rest = rest;
  return parts.text();
}

std::string file_of(double left) {
  hal::FittedWheels wheels;
  wheels.mean.of.left = left;
  wheels.robots.push_back({"ep7", {}, {}});
  wheels.robots.back().error.of.delay_s = 0.002;
  return fitted_file({{"e-puck", {hal::AnyPart(wheels)}}});
}

const hal::FittedWheels* wheels_of(const Outcome& outcome) {
  const auto& robots = outcome.good().robots;
  if (robots.empty() || robots[0].own_kind == nullptr) return nullptr;
  return robots[0].own_kind->part<hal::FittedWheels>();
}

TEST(Fitted, AFileGivesTheRobotsOfItsKindItsParts) {
  const auto path =
      (std::filesystem::temp_directory_path() / ("fitted_" + std::to_string(::getpid()) + ".xml")).string();
  std::ofstream(path) << file_of(0.97);
  const Outcome outcome = read(with("<fitted file=\"" + path + "\" reality=\"7\"/>"));
  const hal::FittedWheels* const wheels = wheels_of(outcome);
  ASSERT_NE(wheels, nullptr) << outcome.text();
  EXPECT_EQ(wheels->mean.of.left, 0.97);
  EXPECT_EQ(wheels->reality, 7);
  ASSERT_EQ(wheels->robots.size(), 1U);
  EXPECT_EQ(wheels->robots[0].id, "ep7");
  EXPECT_EQ(wheels->robots[0].error.of.delay_s, 0.002);

  // The settings that are kept hold it all.
  const Outcome again = read(effective_settings(*outcome.scenario));
  ASSERT_NE(wheels_of(again), nullptr) << again.text();
  EXPECT_EQ(wheels_of(again)->mean.of.left, 0.97);
  EXPECT_EQ(wheels_of(again)->reality, 7);

  const Outcome added = read(with(""), {"fitted.file=" + path, "fitted.reality=2"});
  ASSERT_NE(wheels_of(added), nullptr) << added.text();
  EXPECT_EQ(wheels_of(added)->reality, 2);

  // In the place of what the experiment says.
  const Outcome replaced =
      read(with("<fitted><model kind=\"e-puck\"><fitted_wheels/></model></fitted>"), {"fitted.file=" + path});
  ASSERT_NE(wheels_of(replaced), nullptr) << replaced.text();
  EXPECT_EQ(wheels_of(replaced)->mean.of.left, 0.97);
  std::filesystem::remove(path);
}

TEST(Fitted, SaysWhatIsWrong) {
  EXPECT_THAT(read(with("<fitted file=\"none.xml\"/>")).text(), HasSubstr("file.xml:8: error: <fitted file>"));
  EXPECT_THAT(read(with("<fitted><model kind=\"epuck\"/></fitted>")).text(), HasSubstr("Did you mean 'e-puck'?"));
  EXPECT_THAT(read(with("<fitted><model kind=\"e-puck\"><light/></model></fitted>")).text(),
              HasSubstr("<model> cannot hold <light>"));
  EXPECT_THAT(
      read(with("<fitted><model kind=\"e-puck\"><fitted_wheels><mean left=\"0\"/></fitted_wheels></model></fitted>"))
          .text(),
      HasSubstr("out of range"));
}

}  // namespace
}  // namespace tandem::core
