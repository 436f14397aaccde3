#include "tests/support/policed_bus.h"

#include <fstream>
#include <regex>
#include <sstream>

namespace test {

std::vector<std::string> policedBusOptions(const std::filesystem::path& folder) {
  std::ostringstream installed;
  installed << std::ifstream(KAGAMI_POLICY).rdbuf();
  std::string policy = std::regex_replace(installed.str(), std::regex("group=\"kagami-viewers\""),
                                          std::string("group=\"") + kViewer + "\"");
  policy = std::regex_replace(policy, std::regex("group=\"kagami-operators\""),
                              std::string("group=\"") + kOperator + "\"");
  std::ofstream(folder / "kagami.conf") << policy;
  std::ofstream(folder / "bus.conf")
      << "<busconfig><listen>unix:path=" << (folder / "bus").string() << "</listen>"
      << R"(<auth>EXTERNAL</auth><policy context="default"><allow user="*"/><deny own="*"/>
            <deny send_type="method_call"/><allow send_type="signal"/>
            <allow send_requested_reply="true" send_type="method_return"/>
            <allow send_requested_reply="true" send_type="error"/>
            <allow receive_type="method_call"/><allow receive_type="method_return"/>
            <allow receive_type="error"/><allow receive_type="signal"/>
            <allow send_destination="org.freedesktop.DBus"
                   send_interface="org.freedesktop.DBus"/></policy><include>)"
      << (folder / "kagami.conf").string() << "</include></busconfig>";
  std::filesystem::permissions(folder, std::filesystem::perms(0755));
  return {"--config-file=" + (folder / "bus.conf").string()};
}

}  // namespace test
