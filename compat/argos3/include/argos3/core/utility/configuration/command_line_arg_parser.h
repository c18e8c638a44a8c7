// Flags and options of a program.
#ifndef TANDEM_ARGOS3_COMMAND_LINE_ARG_PARSER_H
#define TANDEM_ARGOS3_COMMAND_LINE_ARG_PARSER_H
#include <functional>
#include <string>
#include <vector>

#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/logging/argos_log.h>
#include <argos3/core/utility/string_utilities.h>

namespace argos {

/// "-s", "--long", "-s VALUE", "--long VALUE", "--long=VALUE"; flags may be joined: "-nz".
class CCommandLineArgParser {
 public:
  CCommandLineArgParser();
  virtual ~CCommandLineArgParser();

  /// Sets `flag` to false, and to true when it is there.
  void AddFlag(char short_name, const std::string& long_name, const std::string& description, bool& flag) {
    flag = false;
    bool* const set = &flag;
    m_vecArguments.push_back(SArgument{short_name, long_name, description, true, [set](const std::string&) { *set = true; }});
  }
  template <typename T>
  void AddArgument(char short_name, const std::string& long_name, const std::string& description, T& value) {
    T* const set = &value;
    m_vecArguments.push_back(SArgument{short_name, long_name, description, false,
                                       [set](const std::string& text) { *set = FromString<T>(text); }});
  }
  virtual void PrintUsage(CARGoSLog& log);
  /// @throws CARGoSException for what was not added
  virtual void Parse(SInt32 count, char** values);

 private:
  struct SArgument {
    char Short;
    std::string Long, Description;
    bool IsFlag;
    std::function<void(const std::string&)> Set;
  };
  const SArgument& Find(const std::string& name, bool is_short) const;
  std::vector<SArgument> m_vecArguments;
};

}  // namespace argos

#endif
