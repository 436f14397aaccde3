#include "tests/studio/movenet.h"

#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <vector>

#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

namespace {

using Json = nlohmann::json;

constexpr int kSide = 256;  // of the picture that goes in
constexpr int kCells = 64;  // of the maps that come out
constexpr int kJoints = 17;
constexpr float kNear = 1.8f;  // cells; the network's own constant of how far counts as near

// Where the four maps come out of the graph.
const std::string kPrefix = "StatefulPartitionedCall/";
const std::array<std::string, 4> kHeads = {kPrefix + "Sigmoid", kPrefix + "Sigmoid_1",
                                           kPrefix + "kpt_regress_0/conv2d_6/BiasAdd",
                                           kPrefix + "kpt_offset_0/conv2d_7/BiasAdd"};

std::string decode(const std::string& base64) {
  static const std::string kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char c : base64) {
    const auto value = kLetters.find(c);
    if (value == std::string::npos) break;
    bits = bits << 6 | static_cast<unsigned>(value);
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes.push_back(static_cast<char>(bits >> count & 0xff));
    }
  }
  return bytes;
}

/// Numbers of the graph, by name; kept as 16 bit floats, the pieces one behind the other.
class Weights {
 public:
  Weights(const Json& list, std::vector<char> bytes) : bytes_(std::move(bytes)) {
    std::size_t at = 0;
    for (const Json& entry : list) {
      Piece piece{.at = at, .shape = entry["shape"].get<std::vector<int>>()};
      piece.half = entry.contains("quantization");
      std::size_t count = 1;
      for (const int side : piece.shape) count *= static_cast<std::size_t>(side);
      piece.count = static_cast<int>(count);
      at += count * (piece.half ? 2 : 4);
      if (at > bytes_.size()) throw std::runtime_error("weights are missing");
      pieces_[entry["name"]] = piece;
    }
  }

  /// One row of floats.
  [[nodiscard]] cv::Mat get(const std::string& name) const {
    const Piece& piece = pieces_.at(name);
    cv::Mat result;
    const cv::Mat stored(1, piece.count, piece.half ? CV_16F : CV_32F,
                         const_cast<char*>(&bytes_[piece.at]));
    stored.convertTo(result, CV_32F);
    return result;
  }
  [[nodiscard]] const std::vector<int>& shape(const std::string& name) const {
    return pieces_.at(name).shape;
  }

 private:
  struct Piece {
    std::size_t at = 0;
    int count = 0;
    bool half = false;
    std::vector<int> shape;
  };
  std::vector<char> bytes_;
  std::map<std::string, Piece> pieces_;
};

/// Walks the graph back from its outputs and puts OpenCV's layers together.
class Builder {
 public:
  Builder(const Json& graph, const Weights& weights) : weights_(weights) {
    for (const Json& node : graph["modelTopology"]["node"]) nodes_[node["name"]] = &node;
  }

  cv::dnn::Net build() {
    for (const std::string& head : kHeads) (void)add(head);
    return net_;
  }

 private:
  struct Made {
    int layer = 0;
    int side = kSide;
  };

  Made put(const std::string& name, const std::string& type, cv::dnn::LayerParams params,
           const std::vector<Made>& inputs, int side) {
    const int layer = net_.addLayer(name, type, params);
    for (std::size_t i = 0; i < inputs.size(); ++i)
      net_.connect(inputs[i].layer, 0, layer, static_cast<int>(i));
    return {layer, side};
  }

  Made add(const std::string& name) {
    if (const auto known = made_.find(name); known != made_.end()) return known->second;
    const auto found = nodes_.find(name);
    if (found == nodes_.end()) throw std::runtime_error("no node " + name);
    const Json& node = *found->second;
    const std::string op = node["op"];
    // Pictures come in as the first normalised value: what precedes is done by blobFromImage.
    if (name == kPrefix + "sub_1") return made_[name] = {};
    const auto input = [&](std::size_t i) { return node["input"][i].get<std::string>(); };
    Made result;
    if (op.find("Conv2D") != std::string::npos || op.find("Conv2dNative") != std::string::npos) {
      result = convolution(name, node, add(input(0)), op.find("Depthwise") != std::string::npos);
    } else if (op == "AddV2") {
      cv::dnn::LayerParams sum;
      sum.set("operation", "sum");
      const std::vector<Made> terms{add(input(0)), add(input(1))};
      result = put(name, "Eltwise", sum, terms, terms.front().side);
    } else if (op == "ResizeBilinear") {
      const Made from = add(input(0));
      cv::dnn::LayerParams twice;
      twice.set("interpolation", "opencv_linear");
      twice.set("width", 2 * from.side);
      twice.set("height", 2 * from.side);
      result = put(name, "Resize", twice, {from}, 2 * from.side);
    } else if (op == "Sigmoid") {
      const Made from = add(input(0));
      result = put(name, "Sigmoid", {}, {from}, from.side);
    } else {
      throw std::runtime_error("operation " + op + " is not MoveNet's");
    }
    return made_[name] = result;
  }

  Made convolution(const std::string& name, const Json& node, const Made& from, bool depthwise) {
    const std::string kernel = node["input"][1];
    const std::vector<int>& shape = weights_.shape(kernel);  // height, width, in, out
    const cv::Mat stored = weights_.get(kernel);
    const int groups = depthwise ? shape[2] : 1;
    const int in = depthwise ? 1 : shape[2];
    const int out = depthwise ? shape[2] * shape[3] : shape[3];
    const std::array<int, 4> sides = {out, in, shape[0], shape[1]};
    cv::Mat turned(4, sides.data(), CV_32F);
    const auto* value = stored.ptr<float>();
    for (int y = 0; y < shape[0]; ++y) {
      for (int x = 0; x < shape[1]; ++x) {
        for (int i = 0; i < shape[2]; ++i) {
          for (int o = 0; o < shape[3]; ++o) {
            const std::array<int, 4> at = {depthwise ? i * shape[3] + o : o, depthwise ? 0 : i, y,
                                           x};
            turned.at<float>(at.data()) = *value++;
          }
        }
      }
    }
    const Json& attributes = node["attr"];
    const int stride = std::stoi(attributes["strides"]["list"]["i"][1].get<std::string>());
    const bool same = decode(attributes["padding"]["s"]) == "SAME";
    const int side = same ? (from.side + stride - 1) / stride : (from.side - shape[0]) / stride + 1;
    const int pad = same ? std::max((side - 1) * stride + shape[0] - from.side, 0) : 0;
    // OpenCV's convolutions pad all sides alike.
    const bool even = pad % 2 == 0;
    Made padded = from;
    if (!even) {
      const std::array<int, 8> sides_of_all = {
          0, 0, 0, 0, pad / 2, pad - pad / 2, pad / 2, pad - pad / 2};
      cv::dnn::LayerParams margin;
      margin.set("paddings", cv::dnn::DictValue::arrayInt(sides_of_all.begin(), 8));
      padded = put(name + "/padded", "Padding", margin, {from}, from.side + pad);
    }
    cv::dnn::LayerParams conv;
    conv.set("kernel_h", shape[0]);
    conv.set("kernel_w", shape[1]);
    conv.set("stride_h", stride);
    conv.set("stride_w", stride);
    conv.set("pad_h", even ? pad / 2 : 0);
    conv.set("pad_w", even ? pad / 2 : 0);
    conv.set("num_output", out);
    conv.set("group", groups);
    conv.blobs.push_back(turned);
    const Json fused = attributes.value("fused_ops", Json::object());
    std::vector<std::string> after;
    if (fused.contains("list"))
      for (const Json& word : fused["list"].value("s", Json::array()))
        after.push_back(decode(word));
    const bool bias = !after.empty() && after.front() == "BiasAdd";
    conv.set("bias_term", bias);
    if (bias) conv.blobs.push_back(weights_.get(node["input"][2]));
    Made result = put(after.size() > 1 ? name + "/sum" : name, "Convolution", conv, {padded}, side);
    if (after.size() > 1)
      result = put(name, after[1] == "Relu6" ? "ReLU6" : "ReLU", {}, {result}, side);
    return result;
  }

  const Weights& weights_;
  std::map<std::string, const Json*> nodes_;
  std::map<std::string, Made> made_;
  cv::dnn::Net net_;
};

}  // namespace

std::expected<MoveNet, std::string> MoveNet::load(const std::filesystem::path& folder) {
  std::ifstream graph_file(folder / "movenet-thunder.json");
  std::ifstream weights_file(folder / "movenet-thunder.bin", std::ios::binary);
  if (!graph_file || !weights_file)
    return std::unexpected(folder.string() + " has no movenet-thunder.json and .bin");
  try {
    const Json graph = Json::parse(graph_file);
    const Weights weights(graph["weightsManifest"].at(0)["weights"],
                          {std::istreambuf_iterator<char>(weights_file), {}});
    return MoveNet(Builder(graph, weights).build());
  } catch (const std::exception& error) {
    return std::unexpected(folder.string() + " holds no MoveNet: " + error.what());
  }
}

std::array<SeenJoint, 17> MoveNet::find(const cv::Mat& bgr, const cv::Rect2f& square) {
  const float scale = square.width / kSide;
  const cv::Matx23f from_crop(scale, 0, square.x + scale / 2 - 0.5f, 0, scale,
                              square.y + scale / 2 - 0.5f);
  cv::Mat crop;
  if (scale > 1.5f) {
    // Shrunk by more than bilinear interpolation covers: smoothed first.
    cv::Mat smooth;
    cv::GaussianBlur(bgr, smooth, {}, 0.4 * static_cast<double>(scale));
    cv::warpAffine(smooth, crop, from_crop, {kSide, kSide},
                   cv::INTER_LINEAR | cv::WARP_INVERSE_MAP);
  } else {
    cv::warpAffine(bgr, crop, from_crop, {kSide, kSide}, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP);
  }
  net_.setInput(cv::dnn::blobFromImage(crop, 1 / 127.5, {kSide, kSide}, cv::Scalar::all(127.5),
                                       /*swapRB=*/true, /*crop=*/false));
  std::vector<cv::Mat> maps;
  net_.forward(maps, std::vector<cv::String>(kHeads.begin(), kHeads.end()));
  const cv::Mat& heat = maps[0];
  const cv::Mat& middle = maps[1];
  const cv::Mat& from_middle = maps[2];
  const cv::Mat& finer = maps[3];

  // The best cell of one map, when cells far from a place count less.
  const auto best = [](const cv::Mat& map, int plane, float y0, float x0) {
    cv::Point found;
    float most = -1;
    for (int y = 0; y < kCells; ++y) {
      const auto* row = map.ptr<float>(0, plane, y);
      for (int x = 0; x < kCells; ++x) {
        const float weight =
            row[x] / (std::hypot(static_cast<float>(x) - x0, static_cast<float>(y) - y0) + kNear);
        if (weight > most) {
          most = weight;
          found = {x, y};
        }
      }
    }
    return found;
  };
  const cv::Point person = best(middle, 0, kCells / 2.0f, kCells / 2.0f);
  std::array<SeenJoint, 17> joints;
  for (int k = 0; k < kJoints; ++k) {
    const float y =
        static_cast<float>(person.y) + from_middle.ptr<float>(0, 2 * k, person.y)[person.x];
    const float x =
        static_cast<float>(person.x) + from_middle.ptr<float>(0, 2 * k + 1, person.y)[person.x];
    const cv::Point cell = best(heat, k, y, x);
    const float fine_y = static_cast<float>(cell.y) + finer.ptr<float>(0, 2 * k, cell.y)[cell.x];
    const float fine_x =
        static_cast<float>(cell.x) + finer.ptr<float>(0, 2 * k + 1, cell.y)[cell.x];
    SeenJoint& joint = joints[static_cast<std::size_t>(k)];
    joint.confidence = heat.ptr<float>(0, k, cell.y)[cell.x];
    joint.at_px = {square.x + fine_x / kCells * square.width - 0.5f,
                   square.y + fine_y / kCells * square.height - 0.5f};
  }
  return joints;
}
