$# Statements: the camera looks along `back`, reversed, at the first view's target.
    fathom_forward = -back;
    fathom_right = normalize(vec3(back.z, 0.0, -back.x));
    fathom_up = cross(fathom_right, fathom_forward);
    fathom_origin = $TARGET + fathom_focus * back;
