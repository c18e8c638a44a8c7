// The corpus uses all that ARGoS users' code calls in two repositories or more.
#include <cstdlib>
#include <gtest/gtest.h>

#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem {
namespace {

TEST(ArgosEntries, AllHaveAPlaceInTheCorpus) {
  const scenarios::Folder folder;
  const std::string log = (folder.path() / "log").string();
  const std::string line = "/usr/bin/python3 '" + std::string(test::kSourceDir) +
                           "/tests/argos_corpus/entries.py' --unused >'" + log + "' 2>&1";
  EXPECT_EQ(std::system(line.c_str()), 0) << scenarios::text_of(log);
}

}  // namespace
}  // namespace tandem
