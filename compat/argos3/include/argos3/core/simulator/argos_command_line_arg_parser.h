// The arguments of the command `argos3`.
#ifndef TANDEM_ARGOS3_ARGOS_COMMAND_LINE_ARG_PARSER_H
#define TANDEM_ARGOS3_ARGOS_COMMAND_LINE_ARG_PARSER_H
#include <argos3/core/utility/configuration/command_line_arg_parser.h>
#include <string>

namespace argos {

class CARGoSCommandLineArgParser : public CCommandLineArgParser {
 public:
  enum EAction { ACTION_UNKNOWN = 0, ACTION_SHOW_HELP, ACTION_SHOW_VERSION, ACTION_RUN_EXPERIMENT, ACTION_QUERY };

  CARGoSCommandLineArgParser();
  ~CARGoSCommandLineArgParser() override;

  void PrintUsage(CARGoSLog& log) override;
  virtual void PrintVersion();
  /// Also opens the log's files. @throws CARGoSException for arguments that make no sense
  void Parse(SInt32 count, char** values) override;
  EAction GetAction() { return m_eAction; }
  const std::string& GetExperimentConfigFile() { return m_strExperimentConfigFile; }
  const std::string& GetQuery() { return m_strQuery; }
  bool IsLogColored() { return !m_bNonColoredLog; }
  bool IsHelpWanted() { return m_bHelpWanted; }
  bool IsForceNoViz() { return m_bForceNoViz; }

 private:
  EAction m_eAction;
  std::string m_strExperimentConfigFile, m_strQuery, m_strLogFile, m_strLogErrFile;
  bool m_bNonColoredLog, m_bHelpWanted, m_bVersionWanted, m_bForceNoViz;
};

}  // namespace argos

#endif
