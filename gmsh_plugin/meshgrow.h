#ifndef MESHGROW_H
#define MESHGROW_H

#include <stddef.h>

/* The C interface of meshgrow: mesh sizes for Gmsh that grow from what is meshed already.
 *
 * Entities are passed as in Gmsh's own C API: arrays of dim, tag, dim, tag, … whose length `…_n`
 * counts the ints. Sizes and coordinates are in model units. Functions that can fail return 0 on
 * success and 1 on failure; meshgrow_last_error() then gives one sentence. Those that return a text
 * (char*) return NULL on failure; every such text is to be freed by meshgrow_free. Nothing is
 * thrown. What fails changes nothing, but for meshgrow_field_generate, which keeps what was meshed
 * before the error.
 *
 * libgmsh is found at run time: the one loaded in the process, else the file named by the
 * environment variable MESHGROW_GMSH_LIB, else the usual names. 4.8 or later is needed.
 *
 * A size function takes start sizes S0 on its sources (`mesh`: the mesh that is there; `fixed`: one
 * size; `curvature` and `proximity`: the geometry) and grows them into what it is attached to and
 * all that bounds that: at the distance R, min(L, S0 + (1 - 1/g) R), with the growth rate g >= 1
 * (1.1 is slow, 1.2 usual, 1.5 fast) and the limit L > 0. The smallest over all facets and
 * functions wins. Sizes are isotropic, distances Euclidean. Sources are best meshed first:
 * meshgrow_field_generate sees to it.
 *
 * Thread safety: as Gmsh itself, one thread at a time, except meshgrow_field_size,
 * meshgrow_field_exact_size, meshgrow_field_smallest_size, meshgrow_field_answer and the callbacks
 * on a field that is not being changed. Their first calls, which read the sources, may come at once
 * as well (one thread reads, the others wait), but for meshgrow_field_answer, which reads none. */

#ifdef __cplusplus
extern "C" {
#endif

#if defined(_WIN32)
#define MESHGROW_API __declspec(dllexport)
#else
#define MESHGROW_API __attribute__((visibility("default")))
#endif

typedef struct meshgrow_field meshgrow_field;

/* Of this header, for #if: major * 10000 + minor * 100 + patch. */
#define MESHGROW_VERSION_NUMBER 100

/* Of the library that runs: "0.1.0" */
MESHGROW_API const char* meshgrow_version(void);

/* The sentence of the last failure in this thread; valid until the next call. */
MESHGROW_API const char* meshgrow_last_error(void);

/* Frees a text returned by this library. */
MESHGROW_API void meshgrow_free(char* text);

/* A size field of Gmsh's current model, without any size function; NULL on failure. Destroying it
 * removes it from Gmsh. */
MESHGROW_API meshgrow_field* meshgrow_field_create(void);
MESHGROW_API void meshgrow_field_destroy(meshgrow_field* field);

/* The mesh on the sources (curves, surfaces) grows into the attachments (curves, surfaces, volumes,
 * with all that bounds them), each layer `growth_rate` >= 1 times the one before, up to
 * `size_limit` > 0. `quad_sides` != 0 sizes a quadrilateral by its four sides, 0 by its two
 * triangles, diagonal included. */
MESHGROW_API int meshgrow_field_add_mesh(meshgrow_field* field, const int* sources,
                                         size_t sources_n, const int* attach, size_t attach_n,
                                         double growth_rate, double size_limit, int quad_sides);

/* The size `size` > 0 on the sources (points, curves, surfaces, volumes) grows likewise. */
MESHGROW_API int meshgrow_field_add_fixed(meshgrow_field* field, const int* sources,
                                          size_t sources_n, const int* attach, size_t attach_n,
                                          double size, double growth_rate, double size_limit);

/* The curvature of the sources (curves, surfaces; a volume stands for its faces, a surface in a
 * model without volumes for its curves as well) grows likewise: an edge of an element may turn by
 * `angle` degrees. Sizes below `min_size` >= 0 become `min_size`. */
MESHGROW_API int meshgrow_field_add_curvature(meshgrow_field* field, const int* sources,
                                              size_t sources_n, const int* attach, size_t attach_n,
                                              double angle, double growth_rate, double size_limit,
                                              double min_size);

/* The gaps between the sources (curves, surfaces; a volume stands for its faces) and what is
 * opposite, through the attachments, grow likewise: `cells_per_gap` > 0 elements fit into each.
 * Gaps that ask for less than `min_size` >= 0 are ignored. */
enum {
  MESHGROW_BETWEEN_AUTOMATIC = 0, /* faces if a volume is attached and sources are not all curves */
  MESHGROW_BETWEEN_FACES = 1,     /* of attached volumes */
  MESHGROW_BETWEEN_EDGES = 2,     /* of surfaces, attached or on the boundary of attachments */
  MESHGROW_BETWEEN_BOTH = 3
};
MESHGROW_API int meshgrow_field_add_proximity(meshgrow_field* field, const int* sources,
                                              size_t sources_n, const int* attach, size_t attach_n,
                                              double cells_per_gap, double growth_rate,
                                              double size_limit, double min_size, int between);

/* What suits most models: curvature (18 degrees) and, between faces and edges, proximity (3 cells)
 * of the attachments themselves; of all entities of the model's highest dimension if there are
 * none. */
MESHGROW_API int meshgrow_field_create_defaults(meshgrow_field* field, const int* attach,
                                                size_t attach_n, double growth_rate,
                                                double size_limit, double min_size);

/* A size function by its one-line text:
 * "mesh source Surface{7} attach Volume{2} growth 1.2 limit 2" */
MESHGROW_API int meshgrow_field_add(meshgrow_field* field, const char* text);

/* The functions have names: `name inner` or `name "inner wall"` in the line of text, else a number
 * in the order of adding, "1" for the first. */
MESHGROW_API size_t meshgrow_field_function_count(const meshgrow_field* field);
/* The name of the function with this index, from 0. */
MESHGROW_API char* meshgrow_field_function_name(const meshgrow_field* field, size_t index);
/* The same for its line of text. */
MESHGROW_API char* meshgrow_field_function_text(const meshgrow_field* field, size_t index);
/* Gives a function another name, which must be free and no number. */
MESHGROW_API int meshgrow_field_rename(meshgrow_field* field, const char* name,
                                       const char* new_name);
/* Puts another definition, a line of text, in the place of a function; only what it acts on is
 * built anew. */
MESHGROW_API int meshgrow_field_modify(meshgrow_field* field, const char* name, const char* text);
/* Takes a function away. */
MESHGROW_API int meshgrow_field_remove(meshgrow_field* field, const char* name);

/* Saves the field, with grids unless the evaluator is exact, to a file (.mgf) that is complete or
 * not there. */
MESHGROW_API int meshgrow_field_save(meshgrow_field* field, const char* path);
/* A saved field, mapped into memory; NULL on failure. It answers as the saved one did, to the bit,
 * and can be asked, shown and registered, but not changed. Needs no Gmsh unless registered. */
MESHGROW_API meshgrow_field* meshgrow_field_load(const char* path);

/* Options, before the field is used: "tolerance" (relative, of the background grid; 0.05),
 * "threads" (that build grids; 0: all), "max_cells" (of each grid, 40 bytes a cell; 0: as many as
 * half of the available memory holds while they are built; a grid that needs more is coarser, with
 * a warning, and more sizes are searched for in the facets), "evaluator" (0: auto, 1: grid, 2:
 * exact), "strict" (1: a mesh size function whose source has no mesh is an error; 0: a warning),
 * "calibrate" (1: the sizes that Gmsh is told are corrected by measured factors, so that its edges
 * get the length asked for; 0). */
MESHGROW_API int meshgrow_field_set_option(meshgrow_field* field, const char* name, double value);

/* Calls `listener` with each line of progress (passes of the mesher, how far a grid is) from the
 * thread that meshes, in place of Gmsh's log; NULL ends that. A result other than 0 stops the work
 * as soon as possible, with an error. */
MESHGROW_API int meshgrow_field_set_progress(meshgrow_field* field,
                                             int (*listener)(const char* line, void* data),
                                             void* data);

/* Asks `wants_stop` from the thread that works whether to stop: before each line of progress and,
 * whether lines are told or not, each time that a part of a grid is built. A result other than 0
 * stops the work with an error; NULL ends that. Within a pass of Gmsh nobody is asked. */
MESHGROW_API int meshgrow_field_set_stop(meshgrow_field* field, int (*wants_stop)(void* data),
                                         void* data);

/* Reads the sources as they are meshed now and builds trees, and grids where they pay (see
 * "evaluator"). If it fails, the field answers as before. */
MESHGROW_API int meshgrow_field_refresh(meshgrow_field* field);

/* Registers the field as Gmsh's size callback (after a refresh), or takes it away. */
MESHGROW_API int meshgrow_field_register(meshgrow_field* field);
MESHGROW_API int meshgrow_field_unregister(meshgrow_field* field);

/* Meshes the model up to dimension `dim` with Gmsh's own algorithms, sources first. What had a mesh
 * before keeps it: node tags, coordinates to the bit, connectivity. With `remesh` != 0, all that is
 * no source of a mesh size function loses its mesh first.
 *
 * On failure, also when stopped, what was meshed before is kept, but for curves of mapped surfaces
 * that were not adjusted to each other yet. Premeshed entities, Gmsh's options, visibility and
 * current model are as before, and the next call goes on. */
MESHGROW_API int meshgrow_field_generate(meshgrow_field* field, int dim, int remesh);

/* The passes that this would make, as text. */
MESHGROW_API char* meshgrow_field_plan(meshgrow_field* field, int dim);

/* The same as JSON: [{"dim": …, "attached": …, "entities": …, "functions": …, "sources": …}, …]. */
MESHGROW_API char* meshgrow_field_plan_json(meshgrow_field* field, int dim);

/* Combines the field with sizes of the caller's own: Gmsh is told the smaller one, on every entity
 * of the model. `size_so_far` is what Gmsh would be told without. A result that is not positive and
 * finite counts as none. Called from several threads at once when Gmsh uses several; NULL ends
 * that. */
MESHGROW_API int meshgrow_field_combine(meshgrow_field* field,
                                        double (*sizes)(int dim, int tag, double x, double y,
                                                        double z, double size_so_far, void* data),
                                        void* data);

/* Sizes asked for on an entity at `points_n` points (three doubles each) into `sizes`; infinite
 * where no function acts; before Gmsh applies its Mesh.MeshSizeMin, Max and Factor. From the grid,
 * or exact without it. The first call reads the sources, and every call those that were meshed anew
 * since: looking for that takes some 0.05 µs a node of the sources, so ask for many points at
 * once. */
MESHGROW_API int meshgrow_field_size(meshgrow_field* field, int dim, int tag, const double* points,
                                     size_t points_n, double* sizes);
MESHGROW_API int meshgrow_field_exact_size(meshgrow_field* field, int dim, int tag,
                                           const double* points, size_t points_n, double* sizes);

/* The same for who knows no entity: the smallest size that any function asks for anywhere. */
MESHGROW_API int meshgrow_field_smallest_size(meshgrow_field* field, const double* points,
                                              size_t points_n, double* sizes);

/* Puts the field into Gmsh as a post-processing view `name` and tells the view's tag. `kind`:
 * "cells" (of the background grid, as hexahedra), "plane" (a cut, as quadrangles) or "mesh" (at the
 * nodes of the mesh that the model has). Shows the field of the entity (dim, tag), or with a
 * negative `dim` the smallest size that any function asks for. `plane`: a point and a normal, or
 * NULL for the plane through the middle of the entity's box, square to its shortest side (z where
 * sides are equal). `resolution`: so many squares along the longer side of the cut, divided further
 * where sizes bend; 0 for 32. */
MESHGROW_API int meshgrow_field_add_view(meshgrow_field* field, const char* name, const char* kind,
                                         int dim, int tag, const double* plane, int resolution,
                                         int* view_tag);

/* Writes the field of the entity (dim, tag), or with a negative `dim` the smallest size that any
 * function asks for, into a file that other programs read, by its ending: .vtu (for ParaView: the
 * cells of the background grid), .pos (a view that any Gmsh can take for a background field: within
 * the tolerance of the field) or .msh (the same cells as a mesh). The file is there completely, or
 * as before. `cells`, unless NULL, gets their number. */
MESHGROW_API int meshgrow_field_write_view(meshgrow_field* field, const char* path, int dim,
                                           int tag, size_t* cells);

/* Which size function and which facet decides the size on an entity at a point (three doubles), as
 * JSON: {"size": …, "exact_size": …, "interpolated_size": … or null without a grid, "rule":
 * "facet", "limit", "inside source" or "nothing", "function": {"index": …, "name": …, "kind": …,
 * "text": …}, "facet": {"entity": [dim, tag], "element": tag or null, "corners": […], "start_size":
 * …, "growth_rate": …, "slope": …, "distance": …} or null, "entity": …, "point": …}. The first call
 * reads the sources. */
MESHGROW_API char* meshgrow_field_probe_json(meshgrow_field* field, int dim, int tag,
                                             const double* point);

/* What Gmsh is told when it proposes `proposed` itself: the smaller of the two. */
MESHGROW_API double meshgrow_field_answer(const meshgrow_field* field, int dim, int tag, double x,
                                          double y, double z, double proposed);

/* A field as a size callback of Gmsh, with the field as its data, in Gmsh 4.9 and later:
 *
 *   gmshModelMeshSetSizeCallback(meshgrow_field_callback, field, &ierr);
 *
 * and in 4.8, which passes no proposal (1e22 stands for "no size"), or called within a callback of
 * the caller's own. The answer is that of meshgrow_field_answer. The first call reads the sources,
 * as meshgrow_field_register does; a mesh that Gmsh throws away as it begins is taken as it was
 * when the function was added, or at the last meshgrow_field_refresh. Where that fails, a warning
 * in Gmsh's log says why, and the answer is the proposal. May be called from several threads; not
 * at the same time as other functions of this field. */
MESHGROW_API double meshgrow_field_callback(int dim, int tag, double x, double y, double z,
                                            double proposed, void* field);
MESHGROW_API double meshgrow_field_callback_4_8(int dim, int tag, double x, double y, double z,
                                                void* field);

/* Functions, groups and grids as text for people. */
MESHGROW_API char* meshgrow_field_summary(meshgrow_field* field);

/* The same as JSON: {"functions": […], "groups": [{"entities": …, "grid": …}, …], "seconds":
 * {"gmsh": …, "meshgrow": …}}, the last being the wall time of the last meshgrow_field_generate: in
 * Gmsh's meshers, the sizes that they ask for included, and the rest. */
MESHGROW_API char* meshgrow_field_summary_json(meshgrow_field* field);

/* Gradation and quality of the current model's mesh of dimension `dim` (2 or 3) as JSON, restricted
 * to `entities` unless there are none; against the sizes of `field` unless it is NULL. */
MESHGROW_API char* meshgrow_report_json(int dim, const int* entities, size_t entities_n,
                                        meshgrow_field* field);

/* One number of such a report, such as "elements", "ratio_99" or "length_median", into `value`; not
 * a number if it could not be measured. */
MESHGROW_API int meshgrow_report_value(const char* report_json, const char* name, double* value);

/* At most `count` places that decide the number `name` of that report ("ratio_99", "gamma_min", …),
 * those with the largest values first if `largest` != 0, else those with the smallest, as JSON:
 * [{"value": …, "elements": [tags of Gmsh], "entity": [dim, tag], "point": [x, y, z]}, …]. For
 * "length_share_good", edges that fit worst come first unless `largest` != 0; none for
 * "elements". */
MESHGROW_API char* meshgrow_report_worst_json(int dim, const int* entities, size_t entities_n,
                                              meshgrow_field* field, const char* name, int largest,
                                              size_t count);

/* A table for people of several such reports, a JSON array of {"name": …, "report": …}. */
MESHGROW_API char* meshgrow_report_table(const char* reports_json);

#ifdef __cplusplus
}
#endif

#endif
