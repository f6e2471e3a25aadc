/* A box with a cavity whose faces are meshed first; the volume grows from them. Built with
 *
 *   cc cavity.c $(pkg-config --cflags --libs meshgrow) -lgmsh -o cavity
 */

#include <gmshc.h>
#include <meshgrow.h>
#include <stdio.h>
#include <stdlib.h>

static void check_gmsh(int error) {
  if (error != 0) {
    fprintf(stderr, "error: Gmsh failed\n");
    exit(1);
  }
}

static void check(int failed) {
  if (failed != 0) {
    fprintf(stderr, "error: %s\n", meshgrow_last_error());
    exit(1);
  }
}

/* Makes the model; returns the tag of the volume. */
static int make_model(void) {
  int error = 0;
  gmshModelAdd("cavity", &error);
  check_gmsh(error);
  int box[2] = {3, gmshModelOccAddBox(-2, -2, -2, 4, 4, 4, -1, &error)};
  int hole[2] = {3, gmshModelOccAddBox(-0.5, -0.5, -0.5, 1, 1, 1, -1, &error)};
  int* made = NULL;
  int** map = NULL;
  size_t made_n = 0;
  size_t* map_n = NULL;
  size_t map_nn = 0;
  gmshModelOccCut(box, 2, hole, 2, &made, &made_n, &map, &map_n, &map_nn, -1, 1, 1, &error);
  check_gmsh(error);
  gmshModelOccSynchronize(&error);
  check_gmsh(error);
  const int volume = made[1];
  gmshFree(made);
  for (size_t i = 0; i < map_nn; ++i) {
    gmshFree(map[i]);
  }
  gmshFree(map);
  gmshFree(map_n);
  return volume;
}

/* The faces of the cavity, as dim, tag, dim, tag, …; to be freed with gmshFree. */
static int* cavity_faces(size_t* count) {
  int error = 0;
  int* faces = NULL;
  gmshModelGetEntitiesInBoundingBox(-0.6, -0.6, -0.6, 0.6, 0.6, 0.6, &faces, count, 2, &error);
  check_gmsh(error);
  return faces;
}

/* Meshes these faces only, with elements of 0.08. */
static void mesh_faces(int* faces, size_t faces_n) {
  int error = 0;
  int* all = NULL;
  size_t all_n = 0;
  gmshModelGetEntities(&all, &all_n, -1, &error);
  gmshModelSetVisibility(all, all_n, 0, 0, &error);
  gmshModelSetVisibility(faces, faces_n, 1, 1, &error);
  gmshOptionSetNumber("Mesh.MeshOnlyVisible", 1, &error);
  gmshOptionSetNumber("Mesh.MeshSizeMax", 0.08, &error);
  gmshModelMeshGenerate(2, &error);
  check_gmsh(error);
  gmshOptionSetNumber("Mesh.MeshSizeMax", 0.6, &error);
  gmshOptionSetNumber("Mesh.MeshOnlyVisible", 0, &error);
  gmshModelSetVisibility(all, all_n, 1, 0, &error);
  check_gmsh(error);
  gmshFree(all);
}

int main(int argc, char** argv) {
  int error = 0;
#if GMSH_API_VERSION_MAJOR == 4 && GMSH_API_VERSION_MINOR < 10
  gmshInitialize(0, NULL, 1, &error);
#else
  gmshInitialize(0, NULL, 1, 0, &error);
#endif
  check_gmsh(error);
  gmshOptionSetNumber("General.Verbosity", 2, &error);
  const int volume[2] = {3, make_model()};
  size_t faces_n = 0;
  int* faces = cavity_faces(&faces_n);
  mesh_faces(faces, faces_n);

  meshgrow_field* field = meshgrow_field_create();
  check(field == NULL);
  check(meshgrow_field_add_mesh(field, faces, faces_n, volume, 2, 1.2, 0.6, 0));
  check(meshgrow_field_generate(field, 3, 0));
  gmshFree(faces);

  char* report = meshgrow_report_json(3, volume, 2, field);
  check(report == NULL);
  double ratio = 0.0;
  check(meshgrow_report_value(report, "ratio_99", &ratio));
  printf("99 %% of the neighbours differ by at most %.2f\n%s\n", ratio, report);
  meshgrow_free(report);
  meshgrow_field_destroy(field);
  gmshWrite(argc > 1 ? argv[1] : "cavity.msh", &error);
  check_gmsh(error);
  gmshFinalize(&error);
  return 0;
}
