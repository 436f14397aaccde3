#pragma once

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace test {

inline std::string contentOf(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

inline std::string attribute(const std::string& tag, const std::string& name) {
  std::smatch found;
  return std::regex_search(tag, found, std::regex(" " + name + "=\"([^\"]*)\"")) ? found.str(1)
                                                                                 : "";
}

/// Every member of our interfaces as one line, whatever the layout of the XML.
inline std::set<std::string> membersOf(std::string xml) {
  xml = std::regex_replace(xml, std::regex("<!--[^]*?-->"), "");
  std::set<std::string> members;
  std::string interface;
  std::string member;
  static const std::regex kTag("<(interface|method|signal|property|arg|annotation)( [^>]*)>");
  for (std::sregex_iterator it(xml.begin(), xml.end(), kTag), end; it != end; ++it) {
    const std::string kind = it->str(1);
    const std::string tag = it->str(2);
    const std::string name = attribute(tag, "name");
    if (kind == "interface") {
      interface = name;
      continue;
    }
    if (!interface.starts_with("org.kagami.")) continue;
    if (kind == "arg") {
      members.insert(member + " argument " + name + " " + attribute(tag, "type") + " " +
                     attribute(tag, "direction"));
    } else if (kind == "annotation") {
      members.insert(member + " " + name + " " + attribute(tag, "value"));
    } else {
      member = interface + "." + name;
      members.insert(member + " " + kind + " " + attribute(tag, "type") + " " +
                     attribute(tag, "access"));
    }
  }
  return members;
}

}  // namespace test
