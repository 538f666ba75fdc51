/** @file
 *  The whole library. */
#pragma once

#include <fathom/diagnostic.h>
#include <fathom/explain.h>
#include <fathom/field.h>
#include <fathom/files.h>
#include <fathom/gl.h>
#include <fathom/language.h>
#include <fathom/measure.h>
#include <fathom/mesh.h>
#include <fathom/parts.h>
#include <fathom/picture.h>
#include <fathom/reference.h>
#include <fathom/save_format.h>
#include <fathom/scene.h>
#include <fathom/shader.h>
#include <fathom/slice.h>
#include <fathom/volume.h>
#include <fathom/watch.h>
