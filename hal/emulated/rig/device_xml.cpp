#include "hal/emulated/rig/device_xml.h"

#include <sstream>

#include "hal/emulated/rig/features.h"

namespace emulator {
namespace {

constexpr char kHead[] =
    R"(<?xml version="1.0" encoding="utf-8"?>
<RegisterDescription ModelName="EmulatedCamera" VendorName="Kagami" StandardNameSpace="GEV" SchemaMajorVersion="1" SchemaMinorVersion="1" SchemaSubMinorVersion="0" MajorVersion="1" MinorVersion="0" SubMinorVersion="0" ToolTip="Emulated GigE Vision camera" ProductGuid="0" VersionGuid="0" xmlns="http://www.genicam.org/GenApi/Version_1_1">
)";

std::string hex(std::uint32_t value) {
  std::ostringstream text;
  text << "0x" << std::hex << value;
  return text.str();
}

/// Adds nodes to the description and remembers which of them a person should see.
class XmlWriter {
 public:
  explicit XmlWriter(std::ostringstream& out) : out_(out) {}

  void feature(const Feature& f) {
    if (f.kind == FeatureKind::kFloat) {
      registerNode("FloatReg", f, "");
    } else {
      registerNode("IntReg", f, "<Sign>Unsigned</Sign>");
    }
    switch (f.kind) {
      case FeatureKind::kInteger:
        number("Integer", f);
        break;
      case FeatureKind::kFloat:
        number("Float", f);
        break;
      case FeatureKind::kEnumeration:
        enumeration(f);
        break;
      case FeatureKind::kBoolean:
        out_ << "<Boolean Name=\"" << f.name << "\"><pValue>" << f.name
             << "Reg</pValue><OnValue>1</OnValue><OffValue>0</OffValue></Boolean>\n";
        break;
      case FeatureKind::kCommand:
        out_ << "<Command Name=\"" << f.name << "\"><pValue>" << f.name
             << "Reg</pValue><CommandValue>1</CommandValue></Command>\n";
        break;
    }
    show(f.name);
  }

  void text(std::string_view name, std::uint32_t address, int bytes, bool writable) {
    out_ << "<StringReg Name=\"" << name << "\"><Address>" << hex(address) << "</Address><Length>"
         << bytes << "</Length><AccessMode>" << (writable ? "RW" : "RO")
         << "</AccessMode><pPort>Device</pPort><Cachable>NoCache</Cachable></StringReg>\n";
    show(name);
  }

  void formula(std::string_view name, std::string_view variables, std::string_view formula) {
    out_ << "<IntSwissKnife Name=\"" << name << "\">";
    for (std::size_t at = 0; at < variables.size();) {
      const std::size_t end = std::min(variables.find(' ', at), variables.size());
      const std::string_view variable = variables.substr(at, end - at);
      out_ << "<pVariable Name=\"" << variable << "\">" << variable << "</pVariable>";
      at = end + 1;
    }
    out_ << "<Formula>" << formula << "</Formula></IntSwissKnife>\n";
  }

  void raw(std::string_view nodes) { out_ << nodes; }
  void show(std::string_view name) { shown_ << "<pFeature>" << name << "</pFeature>\n"; }

  void finish() {
    out_ << "<Port Name=\"Device\"></Port>\n<Category Name=\"Root\">\n"
         << shown_.str() << "</Category>\n</RegisterDescription>\n";
  }

 private:
  void registerNode(std::string_view node, const Feature& f, std::string_view more) {
    const bool command = f.kind == FeatureKind::kCommand;
    out_ << '<' << node << " Name=\"" << f.name << "Reg\"><Address>" << hex(f.address)
         << "</Address>";
    if (!f.index_from.empty()) {
      out_ << "<pIndex Offset=\"4\">" << f.index_from << "</pIndex>";
    }
    out_ << "<Length>4</Length><AccessMode>"
         << (command      ? "WO"
             : f.writable ? "RW"
                          : "RO")
         << "</AccessMode><pPort>Device</pPort><Cachable>NoCache</Cachable>" << more
         << "<Endianess>BigEndian</Endianess></" << node << ">\n";
  }

  void number(std::string_view node, const Feature& f) {
    out_.precision(12);
    out_ << '<' << node << " Name=\"" << f.name << "\"><pValue>" << f.name << "Reg</pValue><Min>"
         << f.min << "</Min>";
    if (f.max_from.empty()) {
      out_ << "<Max>" << f.max << "</Max>";
    } else {
      out_ << "<pMax>" << f.max_from << "</pMax>";
    }
    if (f.kind == FeatureKind::kInteger) out_ << "<Inc>" << f.increment << "</Inc>";
    if (!f.unit.empty()) out_ << "<Unit>" << f.unit << "</Unit>";
    out_ << "</" << node << ">\n";
  }

  void enumeration(const Feature& f) {
    out_ << "<Enumeration Name=\"" << f.name << "\">";
    for (const EnumEntry& entry : f.entries) {
      out_ << "<EnumEntry Name=\"" << entry.name << "\"><Value>" << entry.value
           << "</Value></EnumEntry>";
    }
    out_ << "<pValue>" << f.name << "Reg</pValue></Enumeration>\n";
  }

  std::ostringstream& out_;
  std::ostringstream shown_;
};

/// A field of the stream channel's packet size register; bit 0 is the word's highest.
std::string packetSizeField(std::string_view name, std::string_view bits) {
  std::ostringstream node;
  node << "<MaskedIntReg Name=\"" << name << "\"><Address>" << hex(reg::kStreamPacketSize)
       << "</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>"
       << "<Cachable>NoCache</Cachable>" << bits
       << "<Sign>Unsigned</Sign><Endianess>BigEndian</Endianess></MaskedIntReg>\n";
  return node.str();
}

void addPacketSize(XmlWriter& xml, std::uint32_t max_packet_bytes) {
  xml.raw(packetSizeField("GevSCPSPacketSizeReg", "<LSB>31</LSB><MSB>16</MSB>"));
  std::ostringstream node;
  node << "<Integer Name=\"GevSCPSPacketSize\"><pValue>GevSCPSPacketSizeReg</pValue><Min>"
       << kMinPacketBytes << "</Min><Max>" << max_packet_bytes
       << "</Max><Inc>4</Inc><Unit>B</Unit></Integer>\n";
  xml.raw(node.str());
  xml.show("GevSCPSPacketSize");
  xml.raw(packetSizeField("GevSCPSDoNotFragmentReg", "<Bit>1</Bit>"));
  xml.raw(
      "<Boolean Name=\"GevSCPSDoNotFragment\"><pValue>GevSCPSDoNotFragmentReg</pValue>"
      "<OnValue>1</OnValue><OffValue>0</OffValue></Boolean>\n");
  xml.show("GevSCPSDoNotFragment");
  xml.raw(packetSizeField("GevSCPSFireTestPacketReg", "<Bit>0</Bit>"));
  xml.raw(
      "<Command Name=\"GevSCPSFireTestPacket\"><pValue>GevSCPSFireTestPacketReg</pValue>"
      "<CommandValue>1</CommandValue></Command>\n");
  xml.show("GevSCPSFireTestPacket");
}

void addTimestamp(XmlWriter& xml) {
  std::ostringstream nodes;
  nodes << "<IntReg Name=\"TimestampLatchReg\"><Address>" << hex(reg::kTimestampControl)
        << "</Address><Length>4</Length><AccessMode>WO</AccessMode><pPort>Device</pPort>"
        << "<Cachable>NoCache</Cachable><Sign>Unsigned</Sign>"
        << "<Endianess>BigEndian</Endianess></IntReg>\n"
        << "<Command Name=\"TimestampLatch\"><pValue>TimestampLatchReg</pValue>"
        << "<CommandValue>2</CommandValue></Command>\n"
        << "<IntReg Name=\"TimestampLatchValue\"><Address>" << hex(reg::kTimestampValueHigh)
        << "</Address><Length>8</Length><AccessMode>RO</AccessMode><pPort>Device</pPort>"
        << "<Cachable>NoCache</Cachable><Sign>Unsigned</Sign>"
        << "<Endianess>BigEndian</Endianess></IntReg>\n";
  xml.raw(nodes.str());
  xml.show("TimestampLatch");
  xml.show("TimestampLatchValue");
}

}  // namespace

std::string makeDeviceXml(std::uint32_t max_packet_bytes) {
  std::ostringstream out;
  out << kHead;
  XmlWriter xml(out);
  xml.text("DeviceVendorName", 0x48, 32, false);
  xml.text("DeviceModelName", 0x68, 32, false);
  xml.text("DeviceVersion", 0x88, 32, false);
  xml.text("DeviceManufacturerInfo", 0xa8, 48, false);
  xml.text("DeviceSerialNumber", 0xd8, 16, false);
  xml.text("DeviceID", 0xd8, 16, false);
  xml.text("DeviceUserID", reg::kUserName, 16, true);
  xml.formula("OffsetXMax", "SensorWidth Width", "SensorWidth-Width");
  xml.formula("OffsetYMax", "SensorHeight Height", "SensorHeight-Height");
  for (const Feature& f : features()) xml.feature(f);
  xml.formula("PayloadSize", "Width Height", "Width*Height");  // both formats: 8 bits per pixel
  xml.show("PayloadSize");
  addPacketSize(xml, max_packet_bytes);
  addTimestamp(xml);
  xml.raw(
      "<Integer Name=\"TLParamsLocked\"><Visibility>Invisible</Visibility><Value>0</Value>"
      "<Min>0</Min><Max>1</Max></Integer>\n");
  xml.finish();
  return out.str();
}

}  // namespace emulator
