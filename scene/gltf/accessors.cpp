// Reads accessors: typed, strided, normalized, sparse views of buffers. Source: glTF 2.0 specification, 3.6.2.
#include <cmath>
#include <cstring>

#include "scene/gltf/internal.h"

namespace shoal::gltf {
namespace {

int component_size(int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

std::uint32_t load_unsigned(const std::uint8_t* at, int size) {
  std::uint32_t value = 0;
  for (int i = 0; i < size; ++i) value |= static_cast<std::uint32_t>(at[i]) << (8 * i);
  return value;
}

// Converts a normalized integer. Source: specification, 3.11.
float load_component(const std::uint8_t* at, int component_type, bool normalized) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_FLOAT: {
      const std::uint32_t bits = load_unsigned(at, 4);
      float value;
      std::memcpy(&value, &bits, sizeof value);
      return value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: {
      const float value = static_cast<float>(at[0]);
      return normalized ? value / 255.0f : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: {
      const float value = static_cast<float>(load_unsigned(at, 2));
      return normalized ? value / 65535.0f : value;
    }
    case TINYGLTF_COMPONENT_TYPE_BYTE: {
      const float value = static_cast<float>(static_cast<std::int8_t>(at[0]));
      return normalized ? std::fmax(value / 127.0f, -1.0f) : value;
    }
    case TINYGLTF_COMPONENT_TYPE_SHORT: {
      const float value = static_cast<float>(static_cast<std::int16_t>(load_unsigned(at, 2)));
      return normalized ? std::fmax(value / 32767.0f, -1.0f) : value;
    }
    default:
      return 0;
  }
}

// The memory of an accessor's elements. locate (below) checks that it lies inside the buffer.
struct Elements {
  const std::uint8_t* first = nullptr;  // null: all elements are zero
  std::uint64_t stride = 0;
};

//   element_bytes  size of one element
//   may_stride     false for index and sparse data, which are tightly packed
Elements locate(const Document& document, int buffer_view, std::uint64_t byte_offset, std::uint64_t count,
                int element_bytes, int align, bool may_stride, const std::string& label) {
  const tinygltf::BufferView& view = document.model.bufferViews.at(static_cast<std::size_t>(buffer_view));
  const Bytes buffer = document.buffers.at(static_cast<std::size_t>(view.buffer));
  const auto bytes = static_cast<std::uint64_t>(element_bytes);
  if (view.byteStride != 0 && !may_stride) {
    fail(document.path, label + " has a byteStride", "expected tightly packed indices");
  }
  const std::uint64_t stride = view.byteStride != 0 ? view.byteStride : bytes;
  if (stride < bytes) {
    fail(document.path, label + " has a byteStride of " + std::to_string(stride),
         "expected at least " + std::to_string(bytes) + ", one element");
  }
  const auto alignment = static_cast<std::uint64_t>(align);
  if ((view.byteOffset + byte_offset) % alignment != 0 || stride % alignment != 0) {
    fail(document.path, label + " is not aligned", "expected a multiple of " + std::to_string(align) + " bytes");
  }
  // count < 2^32 and stride < 2^8: no overflow; offsets are below 2^40 (schema.cpp).
  const std::uint64_t end = byte_offset + (count - 1) * stride + bytes;
  if (end > view.byteLength) {
    fail(document.path, label + " needs " + std::to_string(end) + " bytes",
         "expected at most " + std::to_string(view.byteLength) + ", the length of its bufferView");
  }
  return {buffer.data() + view.byteOffset + byte_offset, stride};
}

const tinygltf::Accessor& accessor_at(const Document& document, std::size_t index) {
  return document.model.accessors.at(index);
}

std::uint32_t sparse_index(const std::uint8_t* first, std::uint64_t i, int size) {
  return load_unsigned(first + i * static_cast<std::uint64_t>(size), size);
}

// Calls store(element, address of its new value) for each element that the sparse part replaces.
template <class Store>
void apply_sparse(const Document& document, const tinygltf::Accessor& accessor, const std::string& label,
                  int components, const Store& store) {
  if (!accessor.sparse.isSparse) return;
  const auto& sparse = accessor.sparse;
  const auto count = static_cast<std::uint64_t>(sparse.count);
  if (count > accessor.count) {
    fail(document.path, label + ".sparse has " + std::to_string(count) + " elements",
         "expected at most " + std::to_string(accessor.count));
  }
  const int index_type = sparse.indices.componentType;
  if (index_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && index_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
      index_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
    fail(document.path, label + ".sparse.indices has component type " + std::to_string(index_type),
         "expected 5121, 5123 or 5125");
  }
  const int index_size = component_size(index_type);
  const int size = component_size(accessor.componentType);
  const Elements indices =
      locate(document, sparse.indices.bufferView, static_cast<std::uint64_t>(sparse.indices.byteOffset), count,
             index_size, index_size, false, label + ".sparse.indices");
  const Elements replaced =
      locate(document, sparse.values.bufferView, static_cast<std::uint64_t>(sparse.values.byteOffset), count,
             size * components, size, false, label + ".sparse.values");
  std::uint64_t previous = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t index = sparse_index(indices.first, i, index_size);
    if (index >= accessor.count || (i > 0 && index <= previous)) {
      fail(document.path, label + ".sparse.indices[" + std::to_string(i) + "] is " + std::to_string(index),
           "expected increasing indices below " + std::to_string(accessor.count));
    }
    previous = index;
    store(static_cast<std::size_t>(index), replaced.first + i * replaced.stride);
  }
}

std::string accessor_label(const Document& document, std::size_t index, const std::string& use) {
  return label_of("accessors", index, accessor_at(document, index).name) + " (" + use + ")";
}

}  // namespace

std::uint64_t accessor_count(const Document& document, std::size_t accessor) {
  return accessor_at(document, accessor).count;
}

std::vector<float> read_floats(Document& document, std::size_t index, int components, const std::string& use) {
  const tinygltf::Accessor& accessor = accessor_at(document, index);
  const std::string label = accessor_label(document, index, use);
  const int type = accessor.componentType;
  const int size = component_size(type);
  if (size == 0 || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
    fail(document.path, label + " has component type " + std::to_string(type),
         "expected float, or integers of 8 or 16 bits");
  }
  if (accessor.normalized && type == TINYGLTF_COMPONENT_TYPE_FLOAT) {
    fail(document.path, label + " has normalized floats", "expected integers to normalize");
  }
  const std::uint64_t count = accessor.count;
  const auto width = static_cast<std::uint64_t>(components);
  Elements elements;
  if (accessor.bufferView >= 0) {
    elements = locate(document, accessor.bufferView, accessor.byteOffset, count, size * components, size, true, label);
  } else if (count > document.limits.max_unbacked_elements) {
    fail(document.path, label + " has " + std::to_string(count) + " elements and no bufferView",
         "expected at most " + std::to_string(document.limits.max_unbacked_elements));
  }
  charge(document, count * width * sizeof(float), label);
  std::vector<float> values(static_cast<std::size_t>(count * width), 0.0f);
  if (elements.first != nullptr) {
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint8_t* at = elements.first + i * elements.stride;
      for (std::uint64_t c = 0; c < width; ++c) {
        values[static_cast<std::size_t>(i * width + c)] =
            load_component(at + c * static_cast<std::uint64_t>(size), type, accessor.normalized);
      }
    }
  }
  apply_sparse(document, accessor, label, components, [&](std::size_t element, const std::uint8_t* at) {
    for (std::size_t c = 0; c < width; ++c) {
      values[element * width + c] = load_component(at + c * static_cast<std::size_t>(size), type, accessor.normalized);
    }
  });
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) {
      fail(document.path,
           label + " holds " + (std::isnan(values[i]) ? "NaN" : "an infinity") + " in element " +
               std::to_string(i / static_cast<std::size_t>(components)),
           "expected finite numbers");
    }
  }
  return values;
}

std::vector<std::uint32_t> read_indices(Document& document, std::size_t index, std::uint64_t vertex_count) {
  const tinygltf::Accessor& accessor = accessor_at(document, index);
  const std::string label = accessor_label(document, index, "indices");
  const int type = accessor.componentType;
  if (accessor.type != TINYGLTF_TYPE_SCALAR || accessor.normalized ||
      (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
       type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)) {
    fail(document.path, label + " is no list of vertex numbers", "expected SCALAR of type 5121, 5123 or 5125");
  }
  const int size = component_size(type);
  Elements elements;
  if (accessor.bufferView >= 0) {
    elements = locate(document, accessor.bufferView, accessor.byteOffset, accessor.count, size, size, false, label);
  } else if (accessor.count > document.limits.max_unbacked_elements) {
    fail(document.path, label + " has " + std::to_string(accessor.count) + " elements and no bufferView",
         "expected at most " + std::to_string(document.limits.max_unbacked_elements));
  }
  charge(document, accessor.count * sizeof(std::uint32_t), label);
  std::vector<std::uint32_t> indices(accessor.count);
  for (std::size_t i = 0; i < indices.size() && elements.first != nullptr; ++i) {
    indices[i] = load_unsigned(elements.first + i * static_cast<std::size_t>(size), size);
  }
  apply_sparse(document, accessor, label, 1,
               [&](std::size_t element, const std::uint8_t* at) { indices[element] = load_unsigned(at, size); });
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (indices[i] >= vertex_count) {
      fail(document.path, label + "[" + std::to_string(i) + "] is " + std::to_string(indices[i]),
           "expected less than " + std::to_string(vertex_count) + ", the number of vertices");
    }
  }
  return indices;
}

}  // namespace shoal::gltf
