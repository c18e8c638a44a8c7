// Plug-ins that were built against other forms of what crosses to them: each surface of the program, as a file says it.
#include <filesystem>
#include <gmock/gmock.h>

#include "app/catalog.hpp"
#include "hal/plugin_loader.hpp"
#include "tests/checkout.hpp"
#include "tests/hal/plugin_file.hpp"

namespace tandem::app {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// A library whose static constructor ends the program that loads it. Its note is written anew for each test.
class Surfaces : public testing::Test {
 protected:
  Surfaces() : bytes_(test::bytes_of(std::string(test::kBuildDir) + "/tests/hal_plugins/libtest_hal_stale.so")) {}

  std::string refusal_of(const hal::Surface& surface) {
    const std::string path = testing::TempDir() + "libtandem_surface.so";
    for (const std::size_t note : test::notes_of(bytes_, hal::detail::kSurfaceNote))
      test::put_surface(bytes_, note, surface);
    test::write(path, bytes_);
    hal::PluginLoader loader({}, catalog());
    const auto note = loader.inspect(path);
    const std::string inspected = note.ok() ? "" : note.error().message;
    if (!note.ok()) {
      EXPECT_EQ(loader.open(path).error().message, inspected);
    }
    std::filesystem::remove(path);
    return inspected;
  }

 private:
  std::vector<std::byte> bytes_;
};

TEST_F(Surfaces, AStaleOneIsRefusedWhicheverItIs) {
  const hal::PluginLoader loader({}, catalog());
  const std::vector<hal::Surface> all = loader.catalog().surfaces();
  EXPECT_GE(all.size(), 14U);
  for (const hal::Surface& here : all) {
    EXPECT_EQ(refusal_of(here), "") << here.name;
    hal::Surface stale = here;
    stale.digest ^= std::uint64_t{1} << 40;
    EXPECT_THAT(refusal_of(stale),
                AllOf(HasSubstr("it uses " + here.name + " "), HasSubstr("here is " + here.name + " ")));
    stale = here;
    ++stale.number;
    EXPECT_THAT(refusal_of(stale), HasSubstr("it uses " + here.name + " " + std::to_string(stale.number)));
    stale = here;
    stale.size += 8;
    EXPECT_THAT(refusal_of(stale), HasSubstr("as a later release has it")) << here.name;
    stale.size = here.size > 8 ? here.size - 8 : here.size;
    EXPECT_EQ(refusal_of(stale), "") << here.name << ": tables only grow";
  }
}

TEST_F(Surfaces, OneThatTheProgramDoesNotHaveIsRefused) {
  EXPECT_THAT(refusal_of({"teleporter", 1, 2, 3}), HasSubstr("this program has no such surface"));
}

TEST(TheCatalog, SaysOfEverySurfaceWhatCrosses) {
  const std::uint64_t nothing = hal::Layouts<>::digest();
  for (const hal::Surface& surface : catalog().surfaces()) {
    EXPECT_NE(surface.digest, hal::detail::mixed(nothing, alignof(void*)))
        << surface.name << ": its type needs `using Crosses = hal::Layouts<…>`";
  }
}

}  // namespace
}  // namespace tandem::app
