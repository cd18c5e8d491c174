#include "app/pictures.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <memory>

#include "app/values.h"
#include "core/error.h"
#include "scene/images/png.h"

namespace shoal::app {
namespace {

constexpr int kBandRows = 64;    // rows that are interleaved at a time
constexpr int kMaxSize = 16384;  // as --size
constexpr int kMaxChannels = 1024;

[[noreturn]] void fail(const std::string& path, const std::string& what, const std::string& expected) {
  throw Error(fmt::format("{}: {}; expected {}", path, what, expected));
}

// --- Writing --------------------------------------------------------------------------------------------------------

// A stream that remembers why it failed: the libraries only tell that it did.
class RecordingFile : public OIIO::Filesystem::IOFile {
 public:
  explicit RecordingFile(std::FILE* file) : IOFile(file, OIIO::Filesystem::IOProxy::Write) {}
  std::size_t write(const void* data, std::size_t size) override {
    errno = 0;
    const std::size_t written = IOFile::write(data, size);
    if (written != size && error_ == 0) error_ = errno ? errno : EIO;
    return written;
  }
  int error() const { return error_; }

 private:
  int error_ = 0;
};

// An image being written to an open stream.
class Writer {
 public:
  Writer(std::FILE* file, const std::string& path, const char* format, OIIO::ImageSpec spec)
      : path_(path), proxy_(file), output_(OIIO::ImageOutput::create(format)) {
    if (!output_) fail(path_, fmt::format("no writer for {}", format), "an OpenImageIO that has one");
    OIIO::Filesystem::IOProxy* proxy = &proxy_;
    spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    // The library would put today's here.
    spec.attribute("DateTime", "");
    check(output_->open(std::string("picture.") + format, spec));
  }
  void rows(int begin, int end, const void* pixels) {
    check(output_->write_scanlines(begin, end, 0, OIIO::TypeDesc::UNKNOWN, pixels));
  }
  void close() { check(output_->close()); }

 private:
  void check(bool ok) const {
    if (proxy_.error())
      fail(path_, fmt::format("cannot be written ({})", std::strerror(proxy_.error())), "a writable file");
    if (!ok) fail(path_, "cannot be written (" + output_->geterror() + ")", "a writable file");
  }

  std::string path_;
  RecordingFile proxy_;
  std::unique_ptr<OIIO::ImageOutput> output_;
};

void write_png_bytes(std::FILE* file, const std::string& path, int width, int height, const std::uint8_t* rgb) {
  OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT8);
  // Untagged: that is sRGB to every reader, and the tag would bring a text meshlet of the library's along.
  Writer writer(file, path, "png", spec);
  writer.rows(0, height, rgb);
  writer.close();
}

// A plane that goes into the file: where it comes from, and how far apart its samples are.
struct Source {
  std::string name;
  bool is_uint = false;
  const std::uint32_t* uints = nullptr;
  const float* floats = nullptr;
  std::size_t stride = 1;

  std::uint32_t bits(std::size_t pixel) const {
    return is_uint ? uints[pixel * stride] : std::bit_cast<std::uint32_t>(floats[pixel * stride]);
  }
};

// Every sample is four bytes, so pixels interleave as plain words.
void write_sources(std::FILE* file, const std::string& path, int width, int height,
                   const std::vector<Source>& sources) {
  OIIO::ImageSpec spec(width, height, static_cast<int>(sources.size()), OIIO::TypeDesc::FLOAT);
  spec.channelnames.clear();
  for (const Source& source : sources) {
    spec.channelnames.push_back(source.name);
    spec.channelformats.push_back(source.is_uint ? OIIO::TypeDesc::UINT32 : OIIO::TypeDesc::FLOAT);
  }
  const auto alpha = std::find(spec.channelnames.begin(), spec.channelnames.end(), "A");
  spec.alpha_channel = alpha == spec.channelnames.end() ? -1 : static_cast<int>(alpha - spec.channelnames.begin());
  spec.attribute("compression", "zip");
  Writer writer(file, path, "openexr", spec);
  std::vector<std::uint32_t> band;
  for (int begin = 0; begin < height; begin += kBandRows) {
    const int end = std::min(begin + kBandRows, height);
    const std::size_t first = static_cast<std::size_t>(begin) * static_cast<std::size_t>(width);
    const std::size_t count = static_cast<std::size_t>(end - begin) * static_cast<std::size_t>(width);
    band.resize(count * sources.size());
    for (std::size_t c = 0; c < sources.size(); ++c) {
      for (std::size_t i = 0; i < count; ++i) band[i * sources.size() + c] = sources[c].bits(first + i);
    }
    writer.rows(begin, end, band.data());
  }
  writer.close();
}

void add_aov_sources(const AovImage& image, std::vector<Source>& sources) {
  const auto info =
      std::find_if(aov_infos().begin(), aov_infos().end(), [&](const AovInfo& i) { return i.aov == image.aov; });
  for (int c = 0; c < image.channels; ++c) {
    Source source;
    source.name = info->name;
    if (info->channels[0]) source.name += std::string(".") + info->channels[c];
    source.is_uint = info->is_uint;
    source.uints = info->is_uint ? image.uints.data() + c : nullptr;
    source.floats = info->is_uint ? nullptr : image.floats.data() + c;
    source.stride = static_cast<std::size_t>(image.channels);
    sources.push_back(std::move(source));
  }
}

// --- Reading --------------------------------------------------------------------------------------------------------

std::vector<std::uint8_t> read_file(const std::string& path) {
  const auto refuse = [&] {
    fail(path, fmt::format("cannot be read ({})", std::strerror(errno)), "a PNG or EXR file");
  };
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!file) refuse();
  std::vector<std::uint8_t> bytes;
  constexpr std::size_t kStep = std::size_t{1} << 20;
  for (std::size_t read = kStep; read == kStep;) {
    const std::size_t size = bytes.size();
    bytes.resize(size + kStep);
    read = std::fread(bytes.data() + size, 1, kStep, file.get());
    if (std::ferror(file.get())) refuse();
    bytes.resize(size + read);
  }
  return bytes;
}

Picture::Format format_of(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  constexpr std::uint8_t kPng[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'}, kExr[4] = {0x76, 0x2f, 0x31, 0x01};
  const auto begins_with = [&](const auto& magic) {
    return bytes.size() >= sizeof magic && std::memcmp(bytes.data(), magic, sizeof magic) == 0;
  };
  if (begins_with(kPng)) return Picture::Format::kPng;
  if (begins_with(kExr)) return Picture::Format::kExr;
  fail(path, bytes.empty() ? "is empty" : "is neither a PNG nor an EXR", "one of them");
}

SampleType sample_type(const std::string& path, OIIO::TypeDesc type) {
  if (type == OIIO::TypeDesc::UINT8) return SampleType::kUint8;
  if (type == OIIO::TypeDesc::UINT16) return SampleType::kUint16;
  if (type == OIIO::TypeDesc::UINT32) return SampleType::kUint32;
  if (type == OIIO::TypeDesc::FLOAT || type == OIIO::TypeDesc::HALF) return SampleType::kFloat;
  fail(path, fmt::format("has samples of type {}", type.c_str()), "8 or 16 bits, uint32, half or float");
}

// Channels begin to end, all of one type, as planes.
void read_run(OIIO::ImageInput& input, const std::string& path, int begin, int end, Picture& picture) {
  const SampleType type = picture.channels[static_cast<std::size_t>(begin)].type;
  const OIIO::TypeDesc as = type == SampleType::kFloat ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT32;
  const OIIO::TypeDesc narrow = type == SampleType::kUint8 ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::UINT16;
  const bool is_narrow = type == SampleType::kUint8 || type == SampleType::kUint16;
  const auto run = static_cast<std::size_t>(end - begin);
  const std::size_t pixels = static_cast<std::size_t>(picture.width_px) * static_cast<std::size_t>(picture.height_px);
  const std::size_t sample_bytes = type == SampleType::kUint8 ? 1 : is_narrow ? 2 : 4;
  std::vector<std::uint8_t> data(pixels * run * sample_bytes);
  if (!input.read_image(0, 0, begin, end, is_narrow ? narrow : as, data.data())) {
    fail(path, "cannot be read (" + input.geterror() + ")", "an intact picture");
  }
  for (std::size_t c = 0; c < run; ++c) {
    std::vector<std::uint32_t>& bits = picture.channels[static_cast<std::size_t>(begin) + c].bits;
    bits.assign(pixels, 0);
    // Little-endian words: the low bytes are filled.
    for (std::size_t i = 0; i < pixels; ++i) {
      std::uint32_t word = 0;
      std::memcpy(&word, data.data() + (i * run + c) * sample_bytes, sample_bytes);
      bits[i] = word;
    }
  }
}

}  // namespace

void write_png(std::FILE* file, const std::string& path, const Frame& frame) {
  write_png_bytes(file, path, frame.width_px, frame.height_px, frame.srgb8.data());
}

std::string png_bytes(int width_px, int height_px, const std::vector<std::uint8_t>& rgb) {
  const std::string name = "a picture in memory";
  const auto output = OIIO::ImageOutput::create("png");
  if (!output) fail(name, "no writer for png", "an OpenImageIO that has one");
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  OIIO::Filesystem::IOProxy* proxy = &memory;
  OIIO::ImageSpec spec(width_px, height_px, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  spec.attribute("DateTime", "");
  if (!output->open("picture.png", spec) || !output->write_image(OIIO::TypeDesc::UINT8, rgb.data()) ||
      !output->close()) {
    fail(name, "cannot be encoded (" + output->geterror() + ")", "enough memory");
  }
  return {bytes.begin(), bytes.end()};
}

void write_exr(std::FILE* file, const std::string& path, const Frame& frame) {
  std::vector<Source> sources;
  for (std::size_t c = 0; c < 4; ++c) {
    Source source;
    source.name = std::string(1, "RGBA"[c]);
    source.floats = frame.linear.data() + c;
    source.stride = 4;
    sources.push_back(std::move(source));
  }
  for (const AovImage& image : frame.aovs) add_aov_sources(image, sources);
  write_sources(file, path, frame.width_px, frame.height_px, sources);
}

double PictureChannel::value(std::size_t pixel) const {
  return type == SampleType::kFloat ? static_cast<double>(std::bit_cast<float>(bits[pixel])) : bits[pixel];
}

const PictureChannel* Picture::find(const std::string& name) const {
  for (const PictureChannel& channel : channels) {
    if (channel.name == name) return &channel;
  }
  return nullptr;
}

Picture read_picture(const std::string& path) {
  Picture picture;
  std::vector<std::uint8_t> bytes = read_file(path);
  picture.format = format_of(path, bytes);
  if (picture.format == Picture::Format::kPng) bytes = png_pixels_only(bytes, path);
  const char* format = picture.format == Picture::Format::kPng ? "png" : "openexr";
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(format);
  if (!input) fail(path, fmt::format("no reader for {}", format), "an OpenImageIO that has one");
  OIIO::ImageSpec wanted, spec;
  wanted.attribute("oiio:UnassociatedAlpha", 1);  // the samples as they are in the file
  OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
  if (!input->set_ioproxy(&memory) || !input->open("memory", spec, wanted)) {
    fail(path, "cannot be read (" + input->geterror() + ")", "an intact picture");
  }
  if (spec.width < 1 || spec.width > kMaxSize || spec.height < 1 || spec.height > kMaxSize || spec.depth > 1 ||
      spec.nchannels < 1 || spec.nchannels > kMaxChannels) {
    fail(path, fmt::format("has {} x {} pixels of {} channels", spec.width, spec.height, spec.nchannels),
         fmt::format("at most {0} x {0} of {1}", kMaxSize, kMaxChannels));
  }
  picture.width_px = spec.width;
  picture.height_px = spec.height;
  for (int c = 0; c < spec.nchannels; ++c) {
    picture.channels.push_back({spec.channel_name(c), sample_type(path, spec.channelformat(c)), {}});
  }
  for (int begin = 0; begin < spec.nchannels;) {
    int end = begin + 1;
    const auto type_of = [&](int c) { return picture.channels[static_cast<std::size_t>(c)].type; };
    while (end < spec.nchannels && type_of(end) == type_of(begin)) ++end;
    read_run(*input, path, begin, end, picture);
    begin = end;
  }
  if (input->seek_subimage(1, 0)) fail(path, "has more than one part", "one");
  input->close();
  return picture;
}

void write_map(std::FILE* file, const std::string& path, int width_px, int height_px, const std::vector<float>& rgb) {
  if (has_ending(path, ".png")) {
    std::vector<std::uint8_t> codes(rgb.size());
    for (std::size_t i = 0; i < rgb.size(); ++i) {
      codes[i] = static_cast<std::uint8_t>(std::clamp(rgb[i], 0.0f, 1.0f) * 255.0f + 0.5f);
    }
    write_png_bytes(file, path, width_px, height_px, codes.data());
    return;
  }
  std::vector<Source> sources;
  for (std::size_t c = 0; c < 3; ++c) {
    Source source;
    source.name = std::string(1, "RGB"[c]);
    source.floats = rgb.data() + c;
    source.stride = 3;
    sources.push_back(std::move(source));
  }
  write_sources(file, path, width_px, height_px, sources);
}

}  // namespace shoal::app
