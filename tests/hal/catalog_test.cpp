#include "hal/catalog.hpp"

#include <array>
#include <gmock/gmock.h>
#include <stdexcept>

namespace tandem::hal {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

struct Engine {
  static constexpr std::string_view kCategory = "engine";
  std::string_view name;
};
struct OtherEngine {  // of the same category, as a library built against other headers would have it
  static constexpr std::string_view kCategory = "engine";
  using Crosses = Layouts<std::array<char, 1000>>;
  std::string_view name;
};
struct LongerEngine {  // … or one built against later headers of the same number
  static constexpr std::string_view kCategory = "engine";
  std::string_view name;
  float mass_kg = 0.0F;  // not a double, with which its alignment would change on a processor of 32 bits
  int (*wheels)() = nullptr;
};
struct Robot {
  static constexpr std::string_view kCategory = "robot";
  std::string_view kind;
  std::string_view catalog_name() const { return kind; }
};
struct Hook {
  static constexpr std::string_view kCategory = "hook";
  std::string_view name;
};

constexpr Engine kRolling{"rolling"}, kFloating{"floating"}, kAnonymous{""};
constexpr OtherEngine kStrange{"strange"};
constexpr LongerEngine kLonger{"longer", 2.0F, nullptr};
constexpr Robot kRover{"rover"};
constexpr Hook kPainter{"painter"}, kOtherPainter{"painter"};

template <class... T>
std::string error_of(Catalog& catalog, const std::string& origin, const T&... entries) {
  const Status added = catalog.add_from(origin, [&](Registrar& r) { (r.add(entries), ...); });
  return added.ok() ? "" : added.error().message;
}

TEST(Catalog, FindsEntriesByCategoryAndNameAndTellsWhereTheyCameFrom) {
  Catalog catalog;
  EXPECT_EQ(error_of(catalog, "tandem", kRolling, kRover, kFloating), "");
  EXPECT_EQ(catalog.find<Engine>("floating"), &kFloating);
  EXPECT_EQ(catalog.find<Robot>("rover"), &kRover);
  EXPECT_EQ(catalog.find<Robot>("floating"), nullptr);
  EXPECT_EQ(catalog.find<Engine>("Floating"), nullptr);
  EXPECT_THAT(catalog.all<Engine>(), ElementsAre(&kRolling, &kFloating));
  EXPECT_THAT(catalog.names("engine"), ElementsAre("rolling", "floating"));
  EXPECT_EQ(catalog.origin_of(&kRover), "tandem");
  EXPECT_EQ(catalog.origin_of(&catalog), "");
}

TEST(Catalog, RefusesTwoOfOneNameAndNamesBothOrigins) {
  Catalog catalog;
  ASSERT_EQ(error_of(catalog, "tandem", kRolling), "");
  EXPECT_THAT(error_of(catalog, "libmine.so", kFloating, Engine{"rolling"}),
              AllOf(HasSubstr("'libmine.so' registers the engine 'rolling' a second time"),
                    HasSubstr("the first is from tandem")));
  EXPECT_EQ(catalog.find<Engine>("floating"), nullptr) << "an origin with problems adds nothing";
  EXPECT_THAT(error_of(catalog, "libmine.so", kFloating, kFloating), HasSubstr("the first is from libmine.so"));
}

TEST(Catalog, RefusesOneTableUnderTwoNames) {
  Catalog catalog;
  Engine table{"rolling"};
  const Status added = catalog.add_from("tandem", [&](Registrar& r) {
    r.add(table);
    table.name = "gliding";  // as a class of controllers that is registered twice does with its own
    r.add(table);
  });
  ASSERT_FALSE(added.ok());
  EXPECT_THAT(added.error().message,
              AllOf(HasSubstr("'gliding'"), HasSubstr("as 'rolling'"), HasSubstr("derive a class")));
}

TEST(Catalog, ControllersAndHooksOfTwoLibrariesMayShareAName) {
  Catalog catalog;
  EXPECT_EQ(error_of(catalog, "libone.so", kPainter), "");
  EXPECT_EQ(error_of(catalog, "libtwo.so", kOtherPainter), "");
  EXPECT_EQ(catalog.all<Hook>().size(), 2U);
  EXPECT_THAT(error_of(catalog, "libthree.so", kPainter, kOtherPainter), HasSubstr("a second time"));
}

TEST(Catalog, RefusesWhatHasNoNameOrNoType) {
  Catalog catalog;
  const Status added = catalog.add_from("libbad.so", [](Registrar& r) {
    r.add(kAnonymous);
    r.add(CatalogItem{"engine", "nothing", entry_layout<Engine>(), nullptr});
  });
  ASSERT_FALSE(added.ok());
  EXPECT_THAT(added.error().message,
              AllOf(HasSubstr("engine '' without a name"), HasSubstr("engine 'nothing' without a type")));
}

TEST(Catalog, RefusesATypeOfAnotherForm) {
  Catalog catalog;
  ASSERT_EQ(error_of(catalog, "tandem", kRolling), "");
  EXPECT_THAT(error_of(catalog, "libold.so", kStrange),
              AllOf(HasSubstr("engine 'strange'"), HasSubstr("another form than in tandem")));
  EXPECT_THAT(error_of(catalog, "liblate.so", kLonger),
              AllOf(HasSubstr("engine 'longer'"), HasSubstr("another form than in tandem")));
}

TEST(Catalog, ATableFromBeforeSomethingWasAppendedHasZerosThere) {
  Catalog catalog;
  ASSERT_EQ(error_of(catalog, "tandem", kLonger), "");
  ASSERT_EQ(error_of(catalog, "libearly.so", kRolling), "");
  const auto* rolling = catalog.find<LongerEngine>("rolling");
  ASSERT_NE(rolling, nullptr);
  EXPECT_EQ(rolling->name, "rolling");
  EXPECT_EQ(rolling->mass_kg, 0.0F);
  EXPECT_EQ(rolling->wheels, nullptr);
  EXPECT_EQ(catalog.origin_of(rolling), "libearly.so");
  const Catalog copy = catalog;
  EXPECT_EQ(copy.find<LongerEngine>("rolling"), rolling);
}

TEST(Catalog, KnowsSurfacesOfWhichThereIsNoEntry) {
  Catalog catalog;
  catalog.know<Engine>();
  ASSERT_EQ(catalog.surfaces().size(), 1U);
  EXPECT_EQ(catalog.surfaces()[0], SurfaceOf<Engine>::value());
  EXPECT_THAT(error_of(catalog, "libold.so", kStrange), HasSubstr("another form than in this program"));
  ASSERT_EQ(error_of(catalog, "libmine.so", kRover), "");
  EXPECT_EQ(catalog.surfaces().size(), 2U);
}

TEST(Catalog, IsAsBeforeWhenSomebodyThrowsWhileRegistering) {
  Catalog catalog;
  const auto fill = [](Registrar& r) {
    r.add(kRolling);
    throw std::runtime_error("no licence");
  };
  EXPECT_THROW((void)catalog.add_from("libpaid.so", fill), std::runtime_error);
  EXPECT_TRUE(catalog.entries().empty());
}

TEST(Catalog, CopiesAreIndependent) {
  Catalog catalog;
  ASSERT_EQ(error_of(catalog, "tandem", kRolling), "");
  Catalog copy = catalog;
  ASSERT_EQ(error_of(copy, "libmore.so", kFloating), "");
  EXPECT_EQ(catalog.find<Engine>("floating"), nullptr);
  EXPECT_EQ(copy.find<Engine>("rolling"), &kRolling);
}

}  // namespace
}  // namespace tandem::hal
