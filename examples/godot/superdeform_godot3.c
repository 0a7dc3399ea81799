// superdeform in Godot 3 (GDNative, NativeScript 1.0): the class SuperDeform, a Reference.
//
//   open(vertices: PoolVector3Array, normals: PoolVector3Array, triangles: PoolIntArray, style: String) -> String
//   apply(amount: float) -> String
//   vertices() -> PoolVector3Array, normals() -> PoolVector3Array
//
// open and apply give "", or the sentence that says what is wrong. vertices and normals are those of the last apply;
// normals is empty where open got none.
#include "deformed.h"
#include <gdnative_api_struct.gen.h>

static const godot_gdnative_core_api_struct *api;
static const godot_gdnative_ext_nativescript_api_struct *native_script;

static godot_variant text(const char *utf8) {
  godot_variant variant;
  godot_string string = api->godot_string_chars_to_utf8(utf8);
  api->godot_variant_new_string(&variant, &string);
  api->godot_string_destroy(&string);
  return variant;
}

static godot_variant sentence(SdefStatus status, const SdefError *error) {
  if (status == SDEF_STATUS_OK) return text("");
  return text(error->message[0] ? error->message : sdef_status_name(status));
}

static godot_variant open(godot_object *self, void *data, void *deformed, int count, godot_variant **arguments) {
  (void)self, (void)data;
  if (count != 4) return text("open takes vertices, normals, triangles and a style");
  SdefError error = SDEF_ERROR_INIT;
  godot_pool_vector3_array vertices = api->godot_variant_as_pool_vector3_array(arguments[0]);
  godot_pool_vector3_array normals = api->godot_variant_as_pool_vector3_array(arguments[1]);
  godot_pool_int_array triangles = api->godot_variant_as_pool_int_array(arguments[2]);
  godot_string style = api->godot_variant_as_string(arguments[3]);
  godot_char_string style_text = api->godot_string_utf8(&style);
  godot_pool_vector3_array_read_access *vertex_access = api->godot_pool_vector3_array_read(&vertices);
  godot_pool_int_array_read_access *triangle_access = api->godot_pool_int_array_read(&triangles);
  godot_pool_vector3_array_read_access *normal_access = api->godot_pool_vector3_array_read(&normals);
  const godot_int vertex_count = api->godot_pool_vector3_array_size(&vertices);
  const godot_int normal_count = api->godot_pool_vector3_array_size(&normals);
  godot_variant said;
  if (normal_count != 0 && normal_count != vertex_count) {
    said = text("there are normals, but not one for each vertex: give as many, or none");
  } else {
    // A Vector3 of Godot is three floats.
    const float *points = (const float *)api->godot_pool_vector3_array_read_access_ptr(vertex_access);
    const float *directions = (const float *)api->godot_pool_vector3_array_read_access_ptr(normal_access);
    said = sentence(deformed_open(deformed, points, normal_count ? directions : NULL, (uint32_t)vertex_count,
                                  api->godot_pool_int_array_read_access_ptr(triangle_access),
                                  (size_t)api->godot_pool_int_array_size(&triangles),
                                  api->godot_char_string_get_data(&style_text), &error),
                    &error);
  }
  api->godot_pool_vector3_array_read_access_destroy(normal_access);
  api->godot_pool_int_array_read_access_destroy(triangle_access);
  api->godot_pool_vector3_array_read_access_destroy(vertex_access);
  api->godot_char_string_destroy(&style_text);
  api->godot_string_destroy(&style);
  api->godot_pool_int_array_destroy(&triangles);
  api->godot_pool_vector3_array_destroy(&normals);
  api->godot_pool_vector3_array_destroy(&vertices);
  return said;
}

static godot_variant apply(godot_object *self, void *data, void *deformed, int count, godot_variant **arguments) {
  (void)self, (void)data;
  if (count != 1) return text("apply takes an amount");
  SdefError error = SDEF_ERROR_INIT;
  return sentence(deformed_apply(deformed, api->godot_variant_as_real(arguments[0]), &error), &error);
}

static godot_variant pool(const float *vectors, uint32_t count) {
  godot_pool_vector3_array array;
  godot_variant variant;
  api->godot_pool_vector3_array_new(&array);
  if (vectors && count > 0) {
    api->godot_pool_vector3_array_resize(&array, (godot_int)count);
    godot_pool_vector3_array_write_access *access = api->godot_pool_vector3_array_write(&array);
    memcpy(api->godot_pool_vector3_array_write_access_ptr(access), vectors, 3 * sizeof(float) * count);
    api->godot_pool_vector3_array_write_access_destroy(access);
  }
  api->godot_variant_new_pool_vector3_array(&variant, &array);
  api->godot_pool_vector3_array_destroy(&array);
  return variant;
}

static godot_variant vertices(godot_object *self, void *data, void *deformed, int count, godot_variant **arguments) {
  (void)self, (void)data, (void)count, (void)arguments;
  return pool(((Deformed *)deformed)->positions, ((Deformed *)deformed)->vertex_count);
}

static godot_variant normals(godot_object *self, void *data, void *deformed, int count, godot_variant **arguments) {
  (void)self, (void)data, (void)count, (void)arguments;
  return pool(((Deformed *)deformed)->normals, ((Deformed *)deformed)->vertex_count);
}

static void *create(godot_object *self, void *data) {
  (void)self, (void)data;
  return calloc(1, sizeof(Deformed));
}

static void destroy(godot_object *self, void *data, void *deformed) {
  (void)self, (void)data;
  deformed_close(deformed);
  free(deformed);
}

void godot_gdnative_init(godot_gdnative_init_options *options) {
  api = options->api_struct;
  for (unsigned int i = 0; i < api->num_extensions; i++)
    if (api->extensions[i]->type == GDNATIVE_EXT_NATIVESCRIPT) native_script = (const void *)api->extensions[i];
}

void godot_gdnative_terminate(godot_gdnative_terminate_options *options) {
  (void)options;
  api = NULL;
  native_script = NULL;
}

void godot_nativescript_init(void *library) {
  const struct {
    const char *name;
    godot_variant (*call)(godot_object *, void *, void *, int, godot_variant **);
  } methods[] = {{"open", open}, {"apply", apply}, {"vertices", vertices}, {"normals", normals}};
  native_script->godot_nativescript_register_class(library, "SuperDeform", "Reference",
                                                   (godot_instance_create_func){create, NULL, NULL},
                                                   (godot_instance_destroy_func){destroy, NULL, NULL});
  for (size_t i = 0; i < sizeof methods / sizeof *methods; i++)
    native_script->godot_nativescript_register_method(
        library, "SuperDeform", methods[i].name, (godot_method_attributes){GODOT_METHOD_RPC_MODE_DISABLED},
        (godot_instance_method){methods[i].call, NULL, NULL});
}
