#include "hal/plugin_loader.hpp"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>

#include "tests/checkout.hpp"

namespace tandem::hal {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

const fs::path kFolder = fs::path(test::kBuildDir) / "tests" / "hal_plugins";

class Loader : public testing::Test {
 protected:
  std::string error_of(const std::string& library) {
    const Status opened = loader_.open(library);
    EXPECT_FALSE(opened.ok());
    EXPECT_TRUE(loader_.catalog().entries().empty()) << "a library that is refused registers nothing";
    return opened.ok() ? "" : opened.error().message;
  }
  PluginLoader loader_{{kFolder}};
};

TEST_F(Loader, FindsALibraryByAnyOfItsSpellings) {
  const fs::path file = fs::weakly_canonical(kFolder / "libtest_hal_pair.so");
  for (const std::string& name :
       {std::string("test_hal_pair"), std::string("libtest_hal_pair"), std::string("libtest_hal_pair.so"),
        std::string("test_hal_pair.so"), file.string(), (kFolder / "libtest_hal_pair").string()}) {
    const auto found = loader_.find(name);
    ASSERT_TRUE(found.ok()) << name << ": " << found.error().message;
    EXPECT_EQ(found.value(), file) << name;
  }
}

TEST_F(Loader, TakesNoLibraryThatOnlyHasTheNameOfTheOneThatIsAskedFor) {
  for (const std::string& name :
       {std::string("some/other/build/libtest_hal_pair"), std::string("/tree/libtest_hal_pair.so")})
    EXPECT_THAT(error_of(name), AllOf(HasSubstr("library '" + name + "' is not there"),
                                      HasSubstr((kFolder / "libtest_hal_pair.so").string()),
                                      HasSubstr("library=\"libtest_hal_pair\", without a folder, takes it")));
}

TEST_F(Loader, SaysWhatToDoWithALibraryOfArgos) {
  const fs::path file = fs::path(testing::TempDir()) / "libtest_of_argos.so";
  fs::copy_file(kFolder / "libtest_hal_no_plugin.so", file, fs::copy_options::overwrite_existing);
  EXPECT_THAT(error_of(file.string()), HasSubstr("is not a Tandem plug-in"));
  std::ofstream(file, std::ios::app | std::ios::binary) << "_ZTIN5argos14CCI_ControllerE";
  EXPECT_THAT(error_of(file.string()), AllOf(HasSubstr("was built for ARGoS 3"), HasSubstr("CMAKE_PREFIX_PATH=")));
  fs::remove(file);
}

TEST_F(Loader, NamesEveryPlaceThatItLookedAt) {
  const std::string text = error_of("test_hal_pear");
  EXPECT_THAT(text, AllOf(HasSubstr("library 'test_hal_pear' is not there"),
                          HasSubstr((kFolder / "libtest_hal_pear.so").string()),
                          HasSubstr((kFolder / "test_hal_pear").string()), HasSubstr("TANDEM_PLUGIN_PATH")));
}

TEST_F(Loader, AFolderIsNoLibrary) {
  EXPECT_THAT(error_of(kFolder.string()), HasSubstr("is not there"));
}

TEST_F(Loader, GivesTheControllerAskedFor) {
  const auto spin = loader_.controller("test_hal_pair", "spin");
  ASSERT_TRUE(spin.ok()) << spin.error().message;
  EXPECT_EQ(spin.value()->name, "spin");
  EXPECT_EQ(spin.value()->summary, "Turns on the spot.");
  EXPECT_EQ(loader_.catalog().entries().size(), 2U);
}

TEST_F(Loader, ALibraryThatThrowsOrRegistersNothingUsefulIsRefused) {
  for (int i = 0; i < 2; ++i) {  // the second time, too
    EXPECT_THAT(error_of("test_hal_throws"), AllOf(HasSubstr("threw while it registered"), HasSubstr("no licence")));
    EXPECT_THAT(error_of("test_hal_null_type"), AllOf(HasSubstr("controller 'nobody'"), HasSubstr("without a type")));
    EXPECT_THAT(error_of("test_hal_half_type"), AllOf(HasSubstr("controller 'half'"), HasSubstr("lacks functions")));
  }
}

TEST_F(Loader, OpensALibraryOnce) {
  ASSERT_TRUE(loader_.open("test_hal_pair").ok());
  ASSERT_TRUE(loader_.open("libtest_hal_pair.so").ok());
  EXPECT_EQ(loader_.controller("test_hal_pair", "spin").value(),
            loader_.controller("libtest_hal_pair", "spin").value());
  EXPECT_EQ(loader_.catalog().entries().size(), 2U);
}

TEST_F(Loader, KeepsLibrariesApart) {
  ASSERT_TRUE(loader_.open("test_hal_pair").ok());
  ASSERT_TRUE(loader_.open("test_hal_single").ok());
  EXPECT_EQ(loader_.catalog().entries().size(), 3U);
  EXPECT_FALSE(loader_.controller("test_hal_single", "spin").ok());
}

TEST_F(Loader, NamesTheControllersThatThereAre) {
  const auto none = loader_.controller("test_hal_pair", "spinn");
  ASSERT_FALSE(none.ok());
  EXPECT_THAT(none.error().message, HasSubstr("has no controller 'spinn'; it has: forward, spin"));
}

TEST_F(Loader, TakesTheOnlyOneWhenNoNameIsGiven) {
  EXPECT_EQ(loader_.controller("test_hal_single", "").value()->name, "idle");
  EXPECT_FALSE(loader_.controller("test_hal_pair", "").ok()) << "there are two";
}

/// Another kind of entries.
struct Hook {
  static constexpr std::string_view kCategory = "hook";
  std::string_view name;
};

TEST_F(Loader, TellsControllersFromHooks) {
  const auto hook = loader_.get<Hook>("test_hal_single", "idle");
  ASSERT_FALSE(hook.ok());
  EXPECT_THAT(hook.error().message, HasSubstr("has no hook 'idle'; it has: none"));
}

TEST_F(Loader, RefusesASharedObjectThatIsNoPlugin) {
  EXPECT_THAT(error_of("test_hal_no_plugin"), HasSubstr("is not a Tandem plug-in"));
  EXPECT_THAT(error_of("test_hal_stranger"), HasSubstr("is not a Tandem plug-in"));
}

TEST_F(Loader, RefusesAPluginOfAnotherReleaseBeforeAnyOfItRuns) {
  const std::string error = error_of("test_hal_stale");  // running it would abort
  EXPECT_THAT(error, AllOf(HasSubstr("it uses controller 0 (layout "),
                           HasSubstr("here is controller " + std::to_string(SurfaceOf<ControllerType>::kNumber))));
  EXPECT_THAT(error, HasSubstr("cmake --build " + std::string(test::kBuildDir)));
}

/// Binaries of single.cpp as former states of the program built them, on x86-64 and stripped: kept/.
TEST_F(Loader, RefusesPluginsThatWereBuiltBefore) {
  const std::string kept = std::string(test::kSourceDir) + "/tests/hal/plugins/kept/";
#ifdef __x86_64__
  EXPECT_THAT(error_of(kept + "libsingle_before_notes_x86-64.so"),
              AllOf(HasSubstr("one of before 0.1.0"), HasSubstr("no note")));
  EXPECT_THAT(
      error_of(kept + "libsingle_0.1.0_x86-64.so"),
      AllOf(HasSubstr("was built against Tandem 0.1.0 by GCC 12.2.0"), HasSubstr("it uses controller 1 (layout"),
            HasSubstr("here is controller " + std::to_string(SurfaceOf<ControllerType>::kNumber))));
#else
  EXPECT_THAT(error_of(kept + "libsingle_0.1.0_x86-64.so"),
              HasSubstr("is for another processor (x86-64 with 64 bits)"));
#endif
}

TEST_F(Loader, RefusesAPluginWhosePartsWereBuiltAgainstDifferentHeaders) {
  EXPECT_THAT(error_of("test_hal_two_notes"), HasSubstr("it uses controller 0"));
}

TEST_F(Loader, RefusesWhatIsRegisteredPastTheNote) {
  EXPECT_THAT(error_of("test_hal_past_note"),
              AllOf(HasSubstr("registers the engine 'secret'"), HasSubstr("past its note")));
}

TEST_F(Loader, SaysWhichSymbolIsMissing) {
  EXPECT_THAT(error_of("test_hal_unresolved"),
              AllOf(HasSubstr("does not load"), HasSubstr("nobody has its symbol nobody::has_this(double)")));
}

TEST_F(Loader, RefusesAFileThatIsNoSharedObject) {
  const fs::path file = fs::path(testing::TempDir()) / "libtest_hal_text.so";
  std::ofstream(file) << "not a shared object\n";
  EXPECT_THAT(error_of(file.string()), HasSubstr("is no shared object"));
  fs::remove(file);
  EXPECT_THAT(error_of((fs::path(test::kBuildDir) / "tests/libtest_hal_none.so").string()), HasSubstr("is not there"));
}

TEST_F(Loader, GoesOnAfterARefusal) {
  (void)error_of("test_hal_stale");
  EXPECT_TRUE(loader_.open("test_hal_pair").ok());
}

TEST_F(Loader, JudgesWithoutLoading) {
  const auto note = loader_.inspect("test_hal_throws");
  ASSERT_TRUE(note.ok()) << note.error().message;
  EXPECT_TRUE(note.value().uses("controller"));
  EXPECT_FALSE(note.value().uses("bridge"));
  EXPECT_TRUE(loader_.catalog().entries().empty());
}

}  // namespace
}  // namespace tandem::hal
