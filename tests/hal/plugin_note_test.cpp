#include "hal/plugin_note.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <elf.h>
#include <gmock/gmock.h>

#include "hal/catalog.hpp"
#include "hal/controller.hpp"
#include "hal/plugin.hpp"
#include "tests/checkout.hpp"
#include "tests/hal/plugin_file.hpp"

namespace tandem::hal {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::vector<std::byte> plugin() {
  return test::bytes_of(std::string(test::kBuildDir) + "/tests/hal_plugins/libtest_hal_pair.so");
}

std::string error_of(const std::vector<std::byte>& file) {
  const auto note = parse_plugin_note(file);
  return note.ok() ? "" : note.error().message;
}

TEST(PluginNote, TellsWhatAPluginWasBuiltAgainst) {
  const auto note = parse_plugin_note(plugin());
  ASSERT_TRUE(note.ok()) << note.error().message;
  EXPECT_EQ(note.value().release, kRelease);
  EXPECT_EQ(note.value().standard_library, detail::standard_library());
  EXPECT_THAT(note.value().compiler, HasSubstr(__VERSION__));
  EXPECT_THAT(note.value().surfaces,
              testing::UnorderedElementsAre(SurfaceOf<Border>::value(), SurfaceOf<ControllerType>::value()));
}

TEST(PluginNote, FitsWhatItWasBuiltAgainst) {
  Catalog here;
  here.know<Border>();
  here.know<ControllerType>();
  EXPECT_EQ(misfit(parse_plugin_note(plugin()).value(), here.surfaces()), "");
}

TEST(PluginNote, TellsAllThatDoesNotFit) {
  auto note = parse_plugin_note(plugin()).value();
  std::vector<Surface> here = note.surfaces;
  ASSERT_EQ(here.size(), 2U);
  note.release = {9, 8, 7};
  note.compiler = "Some Compiler 3";
  note.surfaces[0].digest ^= 1;
  note.surfaces[1].number += 3;
  note.surfaces.push_back({"teleporter", 2, 0xABC, 8});
  const std::string why = misfit(note, here);
  EXPECT_THAT(why,
              AllOf(HasSubstr("against Tandem 9.8.7 by Some Compiler 3"), HasSubstr("Tandem " + to_text(kRelease))));
  EXPECT_THAT(why, HasSubstr("it uses " + here[1].name + " " + std::to_string(here[1].number + 3)));
  EXPECT_THAT(why, HasSubstr("here is " + here[1].name + " " + std::to_string(here[1].number) + " (layout "));
  EXPECT_THAT(why, HasSubstr("it uses teleporter 2 (layout 0000000000000abc); this program has no such surface"));
}

TEST(PluginNote, AShorterTableFitsAndALongerOneDoesNot) {
  auto note = parse_plugin_note(plugin()).value();
  const std::vector<Surface> here = note.surfaces;
  const auto table = std::find_if(note.surfaces.begin(), note.surfaces.end(),
                                  [](const Surface& s) { return s.name == ControllerType::kCategory; });
  ASSERT_NE(table, note.surfaces.end());
  table->size -= 8;
  EXPECT_EQ(misfit(note, here), "");
  table->size += 16;
  EXPECT_THAT(misfit(note, here), HasSubstr("as a later release has it"));
}

TEST(PluginNote, AnotherFormOfTheStandardLibraryDoesNotFit) {
  auto note = parse_plugin_note(plugin()).value();
  note.standard_library ^= 4U;
  EXPECT_THAT(misfit(note, note.surfaces), HasSubstr("_GLIBCXX_DEBUG"));
  note.standard_library = 8U;
  EXPECT_THAT(misfit(note, note.surfaces), HasSubstr("another standard library"));
}

TEST(PluginNote, AFileForAnotherProcessorIsNamed) {
  for (const int other : {EM_AARCH64, EM_X86_64, EM_ARM}) {
    const auto machine = static_cast<unsigned char>(other);
    std::vector<std::byte> file = plugin();
    if (file[offsetof(Elf64_Ehdr, e_machine)] == std::byte{machine}) continue;
    file[offsetof(Elf64_Ehdr, e_machine)] = std::byte{machine};
    EXPECT_THAT(error_of(file), AllOf(HasSubstr("is for another processor"), HasSubstr("this program runs on")));
  }
  std::vector<std::byte> file = plugin();
  file[EI_CLASS] = file[EI_CLASS] == std::byte{ELFCLASS32} ? std::byte{ELFCLASS64} : std::byte{ELFCLASS32};
  EXPECT_THAT(error_of(file), HasSubstr("is for another processor"));
  file = plugin();
  file[EI_DATA] = std::byte{ELFDATA2MSB};
  EXPECT_THAT(error_of(file), HasSubstr("big-endian"));
}

TEST(PluginNote, AFileThatIsNoSharedObjectIsNone) {
  EXPECT_THAT(error_of({}), HasSubstr("is no shared object"));
  std::vector<std::byte> file = plugin();
  file[offsetof(Elf64_Ehdr, e_type)] = std::byte{ET_EXEC};
  EXPECT_THAT(error_of(file), HasSubstr("is no shared object"));
}

TEST(PluginNote, AFileThatWasCutOffIsNotWhole) {
  const std::vector<std::byte> file = plugin();
  for (std::size_t size = 0; size < 4096 && size < file.size(); size += 7) {
    const std::string error = error_of({file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size)});
    EXPECT_NE(error, "") << size;
  }
  EXPECT_THAT(error_of({file.begin(), file.begin() + 200}), HasSubstr("cut off or damaged"));
}

TEST(PluginNote, ANoteThatIsNoneIsDamaged) {
  std::vector<std::byte> file = plugin();
  test::put(file, test::notes_of(file, detail::kSurfaceNote).front() + 8, 77);  // another type
  EXPECT_THAT(error_of(file), HasSubstr("damaged note"));
  file = plugin();
  const std::size_t build = test::notes_of(file, detail::kBuildNote).front();
  std::memcpy(file.data() + build + 12, "Random", 6);
  EXPECT_THAT(error_of(file), HasSubstr("is not a Tandem plug-in"));
}

}  // namespace
}  // namespace tandem::hal
