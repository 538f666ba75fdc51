// What Khronos' gltf-validator says of GLB files: judge_gltf.cjs FOLDER_OF_NPM FILE… . Status 1 where one
// has an error or a warning.
const fs = require('fs')
const path = require('path')
const [folder, ...files] = process.argv.slice(2)
const validator = require(path.join(path.resolve(folder), 'node_modules', 'gltf-validator'))
const judge = async () => {
  let bad = 0
  for (const file of files) {
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), { uri: path.basename(file) })
    const { numErrors: errors, numWarnings: warnings, messages } = report.issues
    if (errors + warnings === 0) continue
    bad += 1
    console.log(`gltf-validator ${path.basename(file)} WRONG ${errors} errors, ${warnings} warnings`)
    for (const { code, message, pointer } of messages.slice(0, 5)) console.log(`  ${code} ${pointer}: ${message}`)
  }
  console.log(`gltf-validator ${validator.version()}: ${files.length} files, ${bad} with an error or a warning`)
  return bad === 0 && files.length > 0 ? 0 : 1
}
judge().then((status) => process.exit(status))
