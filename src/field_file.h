#ifndef MESHGROW_FIELD_FILE_H
#define MESHGROW_FIELD_FILE_H

#include <string>

#include "size_field.h"

namespace meshgrow {

// A size field as a file (.mgf), memory-mapped when it is read.
//
// All numbers are little-endian, floats as of IEEE 754; "checksum" is the 64-bit XXH3 of the bytes
// named. Every array begins at a multiple of 64 bytes; gaps are zero.
//
//   header, 64 bytes
//      0   8 bytes  89 4D 47 46 0D 0A 1A 0A ("\x89MGF", line ends that a transfer as text spoils)
//      8   u32      version of the format: 1
//     12   u32      0
//     16   u64      bytes of the whole file
//     24   u64      where the directory begins
//     32   u64      its bytes
//     40   u64      its checksum
//     48   u64      0
//     56   u64      checksum of the bytes 0 to 55
//   arrays, as the directory tells
//   directory, at the end of the file; no gaps. "text" is a u64 count of bytes and the bytes
//   (UTF-8), "entity" i32 dimension and i32 tag, "entities" a u64 count and the entities
//     text       version of meshgrow that wrote it
//     f64        relative tolerance of the grids
//     u64        count of entities of the model, and for each
//                  entity; entities on its boundary or embedded; 6 f64: its box (minimum, maximum)
//     u64        count of physical groups, and for each
//                  i32 dimension; i32 tag; text: name; entities
//     u64        count of size functions, and for each
//                  text: its name; text: its line (size_function_text.h); u8: 1 if it has an
//                  effect; u64: its facets
//     u64        count of groups, and for each
//                  u64: count of its functions, and for each an action: u64 index; u8: 1 inside its
//                  source entities; f64: size limit; action: whose limit that is; u64: count of
//                  stretches of facets, and for each u64: first facet, before the tree was made;
//                  u64: index of its function; u64: count of its entities, and for each u64: first
//                  facet within the stretch; entity; the tree; u8: 1 if there is a grid; the grid
//     tree       6 f64: box; 3 f64: centre; f64: unit; f64: largest slope; 7 arrays:
//       facets     96 bytes: 9 f64 corners, i32 count of corners, 4 bytes 0, f64 start size, f64
//                  slope; in the order of the tree (the units of the model)
//       order      u32: index of each facet before the tree was made
//       nodes      448 bytes: WideNode (simd/wide_tree.h), all f32 but the last 8 u32
//       boxes      192 bytes: 24 f32 minima, 24 f32 maxima (x, y, z of 8 children)
//       slopes     f32, one a node
//       blocks     512 bytes: FacetBlock (simd/wide_tree.h)
//       entries    u32: where each block hangs
//     grid       f64: size limit; 3 f64: lowest corner; f64: edge; u32: depth of the table;
//                u32: depth; 5 arrays:
//       blocks     8 u32: codes of the children, by the bits x, y, z; two bits of kind above 30 of
//                  index (grid_nodes.h); the first stands above the root
//       corners    8 f32: sizes at the corners of an interpolated cell
//       begins     u32: where the entries of an exact cell begin; one more than cells
//       entries    u32: parts of the tree: node above eight bits, one a child
//       table      u32: code; u32: depth; the nodes of one depth along x, y, z
//     array      u64: where it begins; u64: count of elements; u32: bytes of one; u32: s, for
//                blocks of 2^s elements; u64: checksum of each block
//
// Blocks are checked when they are first touched, by whoever asks for a size: a damaged one throws
// Error then.

/// Saves the field as it is built: it answers the same to the bit when it is loaded. Equal fields
/// make equal files; so how long building took is not in them. The file is written beside and moved
/// into place when it is complete. Throws Error if a group is not built, or the file cannot be
/// written.
void save_field(const SizeField& field, const std::string& path);

/// Maps a saved field, in a millisecond for a million facets. Throws Error for
/// files that are truncated, damaged or no size fields. The field can be asked; functions can be
/// neither added nor given sources.
SizeField load_field(const std::string& path);

/// Whether the file begins as a size field does.
bool is_field_file(const std::string& path);

}  // namespace meshgrow

#endif
