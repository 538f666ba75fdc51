"""What Blender makes of mesh files: blender -b -P judge_blender.py -- FILE… Each has the same triangles, in the
same box, by the objects' names and with materials where the format has them; else it raises."""

import os
import sys
import traceback

import bpy
import numpy

numpy.bool = bool  # Debian 12's glTF importer of Blender 3.4 still asks numpy 1.24 for it


def read(file):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    suffix = os.path.splitext(file)[1]
    importers = {".glb": bpy.ops.import_scene.gltf, ".obj": bpy.ops.wm.obj_import,
                 ".ply": bpy.ops.import_mesh.ply, ".stl": bpy.ops.import_mesh.stl}
    importers[suffix](filepath=file)
    objects = [o for o in bpy.data.objects if o.type == "MESH"]
    triangles, lo, hi = 0, [1e9] * 3, [-1e9] * 3
    for one in objects:
        one.data.calc_loop_triangles()
        triangles += len(one.data.loop_triangles)
        for vertex in one.data.vertices:
            at = one.matrix_world @ vertex.co
            if suffix in (".ply", ".stl"):  # these importers do not turn y up to z up
                at = [at[0], -at[2], at[1]]
            lo = [min(a, b) for a, b in zip(lo, at)]
            hi = [max(a, b) for a, b in zip(hi, at)]
    materials = sorted({s.material.name for o in objects for s in o.material_slots if s.material})
    print(f"judge: blender {bpy.app.version_string} {os.path.basename(file)}: {len(objects)} objects "
          f"({', '.join(o.name for o in objects[:4])}), {len(materials)} materials, {triangles} triangles")
    return len(objects), materials, triangles, lo, hi


def judge(files):
    found = {os.path.splitext(f)[1]: read(f) for f in files}
    objects, materials, triangles, lo, hi = found[".glb"]
    assert objects > 1 and materials, "objects and materials of the .glb"
    assert found[".obj"][:3] == (objects, materials, triangles), "the .obj has the same"
    assert found[".ply"][2] == found[".stl"][2], "the .ply has as many triangles as the .stl"
    for one, other in ((".glb", ".obj"), (".ply", ".stl"), (".glb", ".stl")):
        apart = max(abs(a - b) for a, b in zip(found[one][3] + found[one][4], found[other][3] + found[other][4]))
        # Parts and the whole have cells of their own: 64 along 6 units.
        assert apart < (0.1 if (one, other) == (".glb", ".stl") else 1e-3), f"the box of {one} and {other}: {apart}"


try:
    judge(sys.argv[sys.argv.index("--") + 1:])
except Exception:
    traceback.print_exc()
    sys.exit(1)
