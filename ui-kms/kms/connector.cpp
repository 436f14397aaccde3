#include "ui-kms/kms/connector.h"

#include <memory>
#include <utility>

namespace ui::kms {
namespace {

template <class T>
std::vector<T> listOf(const T* items, int count) {
  return items == nullptr || count <= 0
             ? std::vector<T>{}
             : std::vector<T>(items, items + static_cast<std::size_t>(count));
}

std::string nameOf(const drmModeConnector& connector) {
  const char* type = drmModeGetConnectorTypeName(connector.connector_type);
  return std::string(type != nullptr ? type : "Unknown") + "-" +
         std::to_string(connector.connector_type_id);
}

}  // namespace

std::optional<Connector> readConnector(int fd, std::uint32_t id, Probe probe) {
  const std::unique_ptr<drmModeConnector, decltype(&drmModeFreeConnector)> read(
      probe == Probe::kSearch ? drmModeGetConnector(fd, id) : drmModeGetConnectorCurrent(fd, id),
      &drmModeFreeConnector);
  if (!read) return std::nullopt;
  Connector connector{.id = id,
                      .name = nameOf(*read),
                      .connected = read->connection == DRM_MODE_CONNECTED,
                      .modes = listOf(read->modes, read->count_modes),
                      .encoders = listOf(read->encoders, read->count_encoders),
                      .properties = Properties::read(fd, id, DRM_MODE_OBJECT_CONNECTOR)};
  const bool headset = connector.properties.value("non-desktop").value_or(0) != 0;
  if (read->connector_type == DRM_MODE_CONNECTOR_WRITEBACK || headset) connector.connected = false;
  return connector;
}

std::optional<Connector> findConnector(int fd, Probe probe) {
  const std::unique_ptr<drmModeRes, decltype(&drmModeFreeResources)> resources(
      drmModeGetResources(fd), &drmModeFreeResources);
  std::optional<Connector> without_modes;
  if (!resources) return without_modes;
  for (const std::uint32_t id : listOf(resources->connectors, resources->count_connectors)) {
    auto connector = readConnector(fd, id, probe);
    if (!connector || !connector->connected) continue;
    if (!connector->modes.empty()) return connector;
    if (!without_modes) without_modes = std::move(connector);
  }
  return without_modes;
}

}  // namespace ui::kms
